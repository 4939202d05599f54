// Line memory and census: columns of five rows of both cameras, and their codes three columns later.
//
// Smoothed, if asked for, each of the three rows that a code looks at is averaged with the rows beside it,
// in weights of 1, 2 and 1 quarters, rounded, and then in the same way along the row. Of the five rows around
// the pixel the outermost stand for those beyond.
//
// Rows outside of the image repeat the nearest one inside, and so do columns. Bit i of a code is set where
// the i-th neighbour is darker than the pixel; the order is that of the library's codes:
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
    // Codes of column - 3, for the token three clocks later.
    output reg [BITS-1:0] left_code,
    output reg [BITS-1:0] right_code
);
    // The four rows above, the nearest in the lowest bits.
    wire [63:0] above;
    wire [15:0] row_0 = inside_height ? pixels : above[15:0];
    wire [15:0] row_1 = first_line ? pixels : above[15:0];
    wire [15:0] row_2 = first_line ? pixels : above[31:16];
    wire [15:0] row_3 = first_line ? pixels : above[47:32];
    wire [15:0] row_4 = first_line ? pixels : above[63:48];
    wire moves = go && valid && first_group;

    stereo_ram #(.BITS(64), .DEPTH(WIDTH)) lines (
        .clk(clk),
        .read(go),
        .read_address(next_column),
        .read_data(above),
        .write(moves && inside_width),
        .write_address(column[ADDRESS_BITS-1:0]),
        .write_data({row_3, row_2, row_1, row_0})
    );

    // One quarter, two and one of both cameras' pixels, rounded.
    function [7:0] average;
        input [7:0] a;
        input [7:0] b;
        input [7:0] c;
        // verilator lint_off UNUSEDSIGNAL
        // The fraction is dropped.
        reg [9:0] sum;
        // verilator lint_on UNUSEDSIGNAL
        begin
            sum = {2'b0, a} + {1'b0, b, 1'b0} + {2'b0, c} + 10'd2;
            average = sum[9:2];
        end
    endfunction

    function [15:0] averages;
        input [15:0] a;
        input [15:0] b;
        input [15:0] c;
        averages = {average(a[15:8], b[15:8], c[15:8]), average(a[7:0], b[7:0], c[7:0])};
    endfunction

    // Averages down the column, for the rows above, in the middle and below; then those of the last columns.
    wire [47:0] down = smooth ? {
        averages(row_4, row_4, row_3), averages(row_3, row_2, row_1), averages(row_1, row_0, row_0)
    } : {row_4, row_2, row_0};
    reg [47:0] down_0, down_1, down_2;
    // Beside `down_0`.
    reg moved, moved_inside, moved_first;

    always @(posedge clk) begin
        if (go) moved <= valid && first_group;
        if (moves) begin
            moved_first <= column == 1;
            moved_inside <= column <= width;
            if (inside_width) down_0 <= down;
            down_1 <= column == 0 ? down : down_0;
            down_2 <= column == 0 ? down : down_1;
        end
    end

    wire [15:0] top = smooth ? averages(down_2[47:32], down_1[47:32], down_0[47:32]) : down_1[47:32];
    wire [15:0] middle = smooth ? averages(down_2[31:16], down_1[31:16], down_0[31:16]) : down_1[31:16];
    wire [15:0] bottom = smooth ? averages(down_2[15:0], down_1[15:0], down_0[15:0]) : down_1[15:0];

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
