// What the methods along paths compare: gradients, brightness and a wide census of both cameras' pixels, five
// columns later.
//
// Of Sobel's gradients along (X) and across (Y) the line, cut off on both sides and counted from 0; half the
// brightness; and eight bits of census, each set where the neighbour is darker than the pixel:
//
//   0 . . . 1 . . . 2
//   . . 3 . x . 4 . .
//   5 . . . 6 . . . 7      (rows at a distance of 2, columns of 4 and 2)
//
// The right image has the range of X at the column and halfway to both its neighbours.
`default_nettype none

module stereo_features #(
    parameter WIDTH = 640,
    parameter COLUMN_BITS = 11,
    parameter ADDRESS_BITS = 10
) (
    input wire clk,
    input wire go,
    // 0 none, 1 low, 2 high.
    input wire [1:0] noise,
    input wire [COLUMN_BITS-1:0] width,
    input wire [ADDRESS_BITS-1:0] next_column,
    // The token's.
    input wire valid,
    input wire [15:0] pixels,
    input wire [COLUMN_BITS-1:0] column,
    input wire first_group,
    input wire inside_width,
    input wire inside_height,
    input wire first_line,
    // Of column - 5, for the token five clocks later. Left: census, brightness, Y, X, from the highest bits.
    output reg [24:0] left,
    // Right: census, brightness, Y, the greatest X, the least one.
    output reg [29:0] right,
    // The left image's brightness, smoothed if that is asked for.
    output reg [7:0] guide,
    // The left pixel and the right one two rows further up.
    output reg [15:0] highest
);
    wire [79:0] rows;
    wire moved, moved_first, moved_inside;
    stereo_lines #(.WIDTH(WIDTH), .COLUMN_BITS(COLUMN_BITS), .ADDRESS_BITS(ADDRESS_BITS)) lines (
        .clk(clk), .go(go), .smooth(noise != 0), .width(width), .next_column(next_column), .valid(valid),
        .pixels(pixels), .column(column), .first_group(first_group), .inside_width(inside_width),
        .inside_height(inside_height), .first_line(first_line), .rows(rows), .moved(moved),
        .moved_first(moved_first), .moved_inside(moved_inside)
    );

    // A gradient shifted by the noise, cut off, and counted from its least value.
    function [4:0] cut;
        input signed [10:0] gradient;
        input [1:0] shift;
        reg signed [10:0] most;
        reg signed [10:0] shifted;
        // verilator lint_off UNUSEDSIGNAL
        reg signed [10:0] counted;
        // verilator lint_on UNUSEDSIGNAL
        begin
            most = shift == 0 ? 11'sd7 : 11'sd9;
            shifted = gradient >>> shift;
            counted = shifted < -most ? 11'sd0 : shifted > most ? most + most : shifted + most;
            cut = counted[4:0];
        end
    endfunction

    // A code of three rows of nine columns: the outer ones of the rows above and below and the middle, and of
    // the pixel's row the two columns beside it and itself.
    function [7:0] ring;
        input [23:0] t;
        input [23:0] m;
        input [23:0] b;
        ring = {
            b[7:0] < m[15:8], b[15:8] < m[15:8], b[23:16] < m[15:8],
            m[7:0] < m[15:8], m[23:16] < m[15:8],
            t[7:0] < m[15:8], t[15:8] < m[15:8], t[23:16] < m[15:8]
        };
    endfunction

    // Whether a column came, and which, two and three clocks after the token's.
    reg moved_2, first_2, inside_2;
    reg first_0, inside_0, first_1, inside_1;
    always @(posedge clk) begin
        if (go && valid && first_group) begin
            first_0 <= column == 2;
            inside_0 <= column <= width + 1'b1;
        end
        if (go) {first_1, inside_1} <= {first_0, inside_0};
        if (go) {moved_2, first_2, inside_2} <= {moved, first_1, inside_1};
    end

    wire [24:0] lefts;
    wire [29:0] rights;
    wire [7:0] guides;
    wire [15:0] top_pixels;
    genvar i;
    generate
        for (i = 0; i < 2; i = i + 1) begin : camera
            wire [7:0] top = rows[64 + 8*i +: 8];
            wire [7:0] up = rows[48 + 8*i +: 8];
            wire [7:0] middle = rows[32 + 8*i +: 8];
            wire [7:0] down = rows[16 + 8*i +: 8];
            wire [7:0] bottom = rows[8*i +: 8];
            // Sums and differences down a column: what X and Y are made of.
            wire [9:0] sum = {2'b0, up} + {1'b0, middle, 1'b0} + {2'b0, down};
            wire signed [10:0] slope = $signed({3'b0, down}) - $signed({3'b0, up});

            // The last columns, the newest in the lowest bits.
            // verilator lint_off UNUSEDSIGNAL
            // A code looks at every second column at most.
            reg [71:0] tops, middles, bottoms;
            // verilator lint_on UNUSEDSIGNAL
            reg [29:0] sums;
            reg signed [10:0] slope_0, slope_1, slope_2;
            always @(posedge clk) begin
                if (go && moved) begin
                    if (moved_first) begin
                        tops <= {9{top}};
                        middles <= {9{middle}};
                        bottoms <= {9{bottom}};
                        sums <= {3{sum}};
                        slope_0 <= slope;
                        slope_1 <= slope;
                        slope_2 <= slope;
                    end else begin
                        tops <= {tops[63:0], moved_inside ? top : tops[7:0]};
                        middles <= {middles[63:0], moved_inside ? middle : middles[7:0]};
                        bottoms <= {bottoms[63:0], moved_inside ? bottom : bottoms[7:0]};
                        sums <= {sums[19:0], moved_inside ? sum : sums[9:0]};
                        if (moved_inside) slope_0 <= slope;
                        slope_1 <= slope_0;
                        slope_2 <= slope_1;
                    end
                end
            end

            // Gradients of the column before the newest one; those of the last five and four columns.
            wire signed [10:0] along = $signed({1'b0, sums[9:0]}) - $signed({1'b0, sums[29:20]});
            wire signed [10:0] across = slope_0 + (slope_1 <<< 1) + slope_2;
            wire [4:0] x = cut(along, noise);
            // verilator lint_off UNUSEDSIGNAL
            reg [24:0] xs;
            // verilator lint_on UNUSEDSIGNAL
            reg [19:0] ys;
            reg [7:0] codes;
            // verilator lint_off UNUSEDSIGNAL
            reg [7:0] pixel;
            reg [7:0] top_pixel;
            // verilator lint_on UNUSEDSIGNAL
            always @(posedge clk) begin
                if (go && moved_2) begin
                    xs <= first_2 ? {5{x}} : {xs[19:0], inside_2 ? x : xs[4:0]};
                    ys <= {ys[14:0], cut(across, noise)};
                end
                if (go) begin
                    codes <= ring(
                        {tops[71:64], tops[39:32], tops[7:0]},
                        {middles[55:48], middles[39:32], middles[23:16]},
                        {bottoms[71:64], bottoms[39:32], bottoms[7:0]}
                    );
                    pixel <= middles[39:32];
                    top_pixel <= tops[39:32];
                end
            end

            wire [4:0] here = xs[19:15];
            assign top_pixels[8*(1-i) +: 8] = top_pixel;
            if (i == 0) begin : is_left
                assign lefts = {codes, pixel[7:1], ys[19:15], here};
                assign guides = pixel;
            end else begin : is_right
                // Halfway to the neighbours.
                // verilator lint_off UNUSEDSIGNAL
                wire [5:0] before_twice = {1'b0, xs[24:20]} + {1'b0, here};
                wire [5:0] after_twice = {1'b0, xs[14:10]} + {1'b0, here};
                // verilator lint_on UNUSEDSIGNAL
                wire [4:0] to_before = before_twice[5:1];
                wire [4:0] to_after = after_twice[5:1];
                wire [4:0] less = to_before < to_after ? to_before : to_after;
                wire [4:0] more = to_before < to_after ? to_after : to_before;
                assign rights = {
                    codes, pixel[7:1], ys[19:15], more > here ? more : here, less < here ? less : here
                };
            end
        end
    endgenerate

    always @(posedge clk) begin
        if (go) begin
            left <= lefts;
            right <= rights;
            guide <= guides;
            highest <= top_pixels;
        end
    end
endmodule

`default_nettype wire
