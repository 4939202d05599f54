// Census: columns of five rows of both cameras, and their codes three columns later.
//
// Rows and columns outside of the image repeat the nearest ones inside. Bit i of a code is set where the i-th
// neighbour is darker than the pixel; the order is that of the library's codes:
//
//   4 bits   . . 0 . .    8 bits   0 . 1 . 2
//            1 . x . 2             3 . x . 4
//            . . 3 . .             5 . 6 . 7      (rows and columns at a distance of 2)
`default_nettype none

module stereo_census #(
    parameter WIDTH = 640,
    parameter COLUMN_BITS = 11,
    parameter ADDRESS_BITS = 10,
    parameter BITS = 8
) (
    input wire clk,
    input wire go,
    input wire smooth,
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
    // Codes of column - 3, for the token four clocks later.
    output reg [BITS-1:0] left_code,
    output reg [BITS-1:0] right_code
);
    // verilator lint_off UNUSEDSIGNAL
    // Two of the five rows are none that a code looks at.
    wire [79:0] rows;
    // verilator lint_on UNUSEDSIGNAL
    wire moved, moved_first, moved_inside;
    stereo_lines #(.WIDTH(WIDTH), .COLUMN_BITS(COLUMN_BITS), .ADDRESS_BITS(ADDRESS_BITS)) lines (
        .clk(clk), .go(go), .smooth(smooth), .width(width), .next_column(next_column), .valid(valid),
        .pixels(pixels), .column(column), .first_group(first_group), .inside_width(inside_width),
        .inside_height(inside_height), .first_line(first_line), .rows(rows), .moved(moved),
        .moved_first(moved_first), .moved_inside(moved_inside)
    );
    wire [15:0] top = rows[79:64];
    wire [15:0] middle = rows[47:32];
    wire [15:0] bottom = rows[15:0];

    // The last five columns of three rows, the newest in the lowest bits.
    reg [79:0] middles;
    // verilator lint_off UNUSEDSIGNAL
    // Four bits look at no corner.
    reg [79:0] tops;
    reg [79:0] bottoms;
    // verilator lint_on UNUSEDSIGNAL

    always @(posedge clk) begin
        if (go && moved) begin
            if (moved_first) begin
                tops <= {5{top}};
                middles <= {5{middle}};
                bottoms <= {5{bottom}};
            end else begin
                tops <= {tops[63:0], moved_inside ? top : tops[15:0]};
                middles <= {middles[63:0], moved_inside ? middle : middles[15:0]};
                bottoms <= {bottoms[63:0], moved_inside ? bottom : bottoms[15:0]};
            end
        end
    end

    // Of a row the right neighbour, the column's pixel and the left neighbour, from the lowest byte.
    function [3:0] plus;
        input [7:0] t;
        input [23:0] m;
        input [7:0] b;
        plus = {b < m[15:8], m[7:0] < m[15:8], m[23:16] < m[15:8], t < m[15:8]};
    endfunction

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

    generate
        if (BITS == 4) begin : four
            always @(posedge clk) begin
                if (go) begin
                    left_code <= plus(
                        tops[39:32], {middles[71:64], middles[39:32], middles[7:0]}, bottoms[39:32]
                    );
                    right_code <= plus(
                        tops[47:40], {middles[79:72], middles[47:40], middles[15:8]}, bottoms[47:40]
                    );
                end
            end
        end else begin : eight
            always @(posedge clk) begin
                if (go) begin
                    left_code <= ring(
                        {tops[71:64], tops[39:32], tops[7:0]},
                        {middles[71:64], middles[39:32], middles[7:0]},
                        {bottoms[71:64], bottoms[39:32], bottoms[7:0]}
                    );
                    right_code <= ring(
                        {tops[79:72], tops[47:40], tops[15:8]},
                        {middles[79:72], middles[47:40], middles[15:8]},
                        {bottoms[79:72], bottoms[47:40], bottoms[15:8]}
                    );
                end
            end
        end
    endgenerate
endmodule

`default_nettype wire
