// Line memory: columns of the five rows around each pixel, of both cameras, smoothed if asked for.
//
// Smoothed, each row is averaged with the rows beside it, in weights of 1, 2 and 1 quarters, rounded, and
// then in the same way along the row. Of the five rows the outermost stand for those beyond. Rows outside
// of the image repeat the nearest one inside, and so do columns.
`default_nettype none

module stereo_lines #(
    parameter WIDTH = 640,
    parameter COLUMN_BITS = 11,
    parameter ADDRESS_BITS = 10
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
    // Two clocks after the token: the column before its own, 16 bits a row, the lowest row in the lowest bits;
    // whether there is one, whether it is the image's first, and whether it lies inside of the image.
    output wire [79:0] rows,
    output reg moved,
    output reg moved_first,
    output reg moved_inside
);
    // The token a clock later, beside the four rows above, the nearest in the lowest bits: block RAM is slow to
    // answer.
    wire [63:0] read_rows;
    reg [63:0] above;
    reg valid_1, inside_width_1, inside_height_1, first_line_1;
    reg [15:0] pixels_1;
    reg [COLUMN_BITS-1:0] column_1;
    always @(posedge clk) begin
        if (go) begin
            above <= read_rows;
            valid_1 <= valid && first_group;
            {inside_width_1, inside_height_1, first_line_1} <= {inside_width, inside_height, first_line};
            pixels_1 <= pixels;
            column_1 <= column;
        end
    end

    wire [15:0] row_0 = inside_height_1 ? pixels_1 : above[15:0];
    wire [15:0] row_1 = first_line_1 ? pixels_1 : above[15:0];
    wire [15:0] row_2 = first_line_1 ? pixels_1 : above[31:16];
    wire [15:0] row_3 = first_line_1 ? pixels_1 : above[47:32];
    wire [15:0] row_4 = first_line_1 ? pixels_1 : above[63:48];
    wire moves = go && valid_1;

    stereo_ram #(.BITS(64), .DEPTH(WIDTH)) lines (
        .clk(clk),
        .read(go),
        .read_address(next_column),
        .read_data(read_rows),
        .write(moves && inside_width_1),
        .write_address(column_1[ADDRESS_BITS-1:0]),
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

    // Averages down the column; then those of the last columns.
    wire [79:0] down = smooth ? {
        averages(row_4, row_4, row_3), averages(row_4, row_3, row_2), averages(row_3, row_2, row_1),
        averages(row_2, row_1, row_0), averages(row_1, row_0, row_0)
    } : {row_4, row_3, row_2, row_1, row_0};
    reg [79:0] down_0, down_1, down_2;

    always @(posedge clk) begin
        if (go) moved <= valid_1;
        if (moves) begin
            moved_first <= column_1 == 1;
            moved_inside <= column_1 <= width;
            if (inside_width_1) down_0 <= down;
            down_1 <= column_1 == 0 ? down : down_0;
            down_2 <= column_1 == 0 ? down : down_1;
        end
    end

    genvar i;
    generate
        for (i = 0; i < 5; i = i + 1) begin : row
            assign rows[16*i +: 16] = smooth
                ? averages(down_2[16*i +: 16], down_1[16*i +: 16], down_0[16*i +: 16])
                : down_1[16*i +: 16];
        end
    endgenerate
endmodule

`default_nettype wire
