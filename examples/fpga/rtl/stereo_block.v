// Winners of a stereo pair as its pixels come in, bit for bit those of the library's methods `fast` and
// `block`.
//
// In: one pixel of each camera in a clock, on a stream with back-pressure. Out: a record of eight bytes for
// each pixel, in order, on another. The stages, each a file:
//
//   stereo_walk        the frame's way through lines and columns, and what is wrong with its stream
//   stereo_census      five rows around each column, and the codes of both cameras
//   stereo_window      Hamming distances, summed down the columns and along the row
//   stereo_search      winners, with the costs beside them, the second best if it is sought, and what the
//                      winner's partner keeps: records on their way out
//   stereo_registers   size, search and status
//
// METHOD 0 is `fast` (4-bit census, 9 x 7 pixels), 1 is `block` (8-bit census, 9 x 9 pixels, in quarters).
// PARALLEL divides DISPARITIES: with PARALLEL = DISPARITIES a column takes one clock, with an eighth of them
// eight. With SECOND_BEST = 1 records have the least cost of what is not beside the winner, which the
// uniqueness check and confidences look at; else 255.
`default_nettype none

module stereo_block #(
    parameter WIDTH = 640,
    parameter DISPARITIES = 64,
    parameter PARALLEL = 64,
    parameter METHOD = 1,
    parameter SECOND_BEST = 0
) (
    input wire clk,
    input wire reset,
    // Pixels: the left one in bits 7..0, the right one in bits 15..8; `tuser` with the first of a frame,
    // `tlast` with the last of a line.
    input wire [15:0] s_axis_tdata,
    input wire s_axis_tvalid,
    output wire s_axis_tready,
    input wire s_axis_tuser,
    input wire s_axis_tlast,
    // Records: `tuser` with the first of a frame, `tlast` with the last of a row.
    output wire [63:0] m_axis_tdata,
    output wire m_axis_tvalid,
    input wire m_axis_tready,
    output wire m_axis_tuser,
    output wire m_axis_tlast,
    // Registers.
    input wire wb_cyc_i,
    input wire wb_stb_i,
    input wire wb_we_i,
    input wire [5:2] wb_adr_i,
    input wire [31:0] wb_dat_i,
    output wire [31:0] wb_dat_o,
    output wire wb_ack_o
);
    localparam BITS = METHOD == 0 ? 4 : 8;
    localparam RADIUS_Y = METHOD == 0 ? 3 : 4;
    localparam SUM_BITS = METHOD == 0 ? 5 : 7;
    localparam SHIFT = METHOD == 0 ? 0 : 2;
    localparam GROUPS = DISPARITIES / PARALLEL;
    localparam GROUP_BITS = GROUPS == 1 ? 1 : $clog2(GROUPS);
    localparam COLUMN_BITS = WIDTH < 500 ? 9 : $clog2(WIDTH + 8);
    localparam ADDRESS_BITS = $clog2(WIDTH);
    localparam CODE_BITS = $clog2((2 * RADIUS_Y + 1) * WIDTH);
    localparam LEVELS = $clog2(PARALLEL);
    // Clocks from the walk's token to the sums.
    localparam AHEAD = 8;
    // Clocks from the winner to the second best.
    localparam LATER = SECOND_BEST == 0 ? 0 : GROUPS + LEVELS + 1;

    wire go;
    wire enable, running, begins, aborts, too_short, too_long, cut_off;
    wire [COLUMN_BITS-1:0] set_width, width, column;
    wire [ADDRESS_BITS-1:0] next_column;
    wire [15:0] set_height, pixels, row;
    wire [7:0] set_disparities, disparities;
    wire [1:0] set_noise, noise;
    wire smooth = noise != 0;
    wire [7:0] set_least, least;
    wire valid, first_group, last_group, inside_width, inside_height, first_line;
    wire first_code, enters, leaves, has_winners, drains;
    wire [GROUP_BITS-1:0] group;
    wire [CODE_BITS-1:0] code_row;
    wire forget;
    wire restarts = reset || forget;
    wire forgets = restarts || aborts;

    // verilator lint_off UNUSEDSIGNAL
    wire has_last;
    // verilator lint_on UNUSEDSIGNAL
    stereo_walk #(
        .WIDTH(WIDTH),
        .DEPTH(AHEAD + LEVELS + LATER + 13),
        .GROUPS(GROUPS),
        .RADIUS_Y(RADIUS_Y),
        .COLUMN_BITS(COLUMN_BITS),
        .GROUP_BITS(GROUP_BITS),
        .ADDRESS_BITS(ADDRESS_BITS),
        .CODE_BITS(CODE_BITS)
    ) walk (
        .clk(clk), .reset(restarts), .go(go),
        .enable(enable), .set_width(set_width), .set_height(set_height), .set_disparities(set_disparities),
        .set_noise(set_noise), .set_least(set_least), .pixel_data(s_axis_tdata), .pixel_valid(s_axis_tvalid),
        .pixel_user(s_axis_tuser), .pixel_last(s_axis_tlast), .pixel_ready(s_axis_tready),
        .width(width), .disparities(disparities), .noise(noise), .least(least), .running(running),
        .begins(begins), .aborts(aborts), .too_short(too_short), .too_long(too_long), .cut_off(cut_off),
        .next_column(next_column), .valid(valid), .pixels(pixels), .column(column), .group(group),
        .first_group(first_group), .last_group(last_group), .inside_width(inside_width),
        .inside_height(inside_height), .first_line(first_line), .first_code(first_code), .enters(enters),
        .leaves(leaves), .code_row(code_row), .has_last(has_last), .has_winners(has_winners), .row(row), .drains(drains)
    );

    wire [BITS-1:0] left_code;
    wire [BITS-1:0] right_code;

    stereo_census #(
        .WIDTH(WIDTH), .COLUMN_BITS(COLUMN_BITS), .ADDRESS_BITS(ADDRESS_BITS), .BITS(BITS)
    ) census (
        .clk(clk), .go(go), .smooth(smooth), .width(width), .next_column(next_column), .valid(valid),
        .pixels(pixels), .column(column),
        .first_group(first_group), .inside_width(inside_width), .inside_height(inside_height),
        .first_line(first_line), .left_code(left_code), .right_code(right_code)
    );

    // The token beside the codes, which are those of the column three before.
    localparam TOKEN = 6 + COLUMN_BITS + GROUP_BITS + CODE_BITS;
    localparam [COLUMN_BITS-1:0] THREE = 3;
    localparam [COLUMN_BITS-1:0] FOUR = 4;
    localparam [COLUMN_BITS-1:0] SIX = 6;
    wire [COLUMN_BITS-1:0] code_column = column - THREE;
    wire code_inside = column >= 3 && code_column < width;
    wire [CODE_BITS-1:0] code_address = code_row + {{(CODE_BITS-COLUMN_BITS){1'b0}}, code_column};
    reg [TOKEN-1:0] token_2;
    reg [TOKEN-1:0] token_3;
    reg [TOKEN-1:0] token_4;
    reg [TOKEN-1:0] token_5;
    reg [7:0] valids;
    always @(posedge clk) begin
        if (go) begin
            token_2 <= {
                last_group, first_group, code_inside, first_code, enters, leaves,
                code_column, group, code_address
            };
            token_3 <= token_2;
            token_4 <= token_3;
            token_5 <= token_4;
        end
        if (forgets) valids <= 0;
        else if (go) valids <= {valids[6:0], valid && column >= 3 && !drains};
    end

    wire [COLUMN_BITS-1:0] column_5 = token_5[CODE_BITS + GROUP_BITS +: COLUMN_BITS];
    wire [GROUP_BITS-1:0] group_5 = token_5[CODE_BITS +: GROUP_BITS];
    wire last_group_5, first_group_5, inside_5, first_code_5, enters_5, leaves_5;
    assign {last_group_5, first_group_5, inside_5, first_code_5, enters_5, leaves_5} = token_5[TOKEN-1 -: 6];
    wire [8*PARALLEL-1:0] sums;

    stereo_window #(
        .WIDTH(WIDTH),
        .DISPARITIES(DISPARITIES),
        .PARALLEL(PARALLEL),
        .GROUPS(GROUPS),
        .RADIUS_Y(RADIUS_Y),
        .BITS(BITS),
        .SUM_BITS(SUM_BITS),
        .SHIFT(SHIFT),
        .COLUMN_BITS(COLUMN_BITS),
        .GROUP_BITS(GROUP_BITS),
        .CODE_BITS(CODE_BITS)
    ) window (
        .clk(clk), .reset(forgets), .go(go), .least(least), .read_code(token_4[CODE_BITS-1:0]),
        .read_column(token_4[CODE_BITS + GROUP_BITS +: COLUMN_BITS]),
        .valid(valids[3]), .column(column_5), .group(group_5), .first_group(first_group_5),
        .in_image(inside_5), .first_code(first_code_5), .enters(enters_5), .leaves(leaves_5),
        .code_address(token_5[CODE_BITS-1:0]), .left_code(left_code), .right_code(right_code), .sums(sums)
    );

    // The token beside the sums, which are those of the column four before.
    localparam LATE = 2 + COLUMN_BITS + GROUP_BITS;
    reg [4*LATE-1:0] lates;
    always @(posedge clk) begin
        if (go) lates <= {lates[3*LATE-1:0], last_group_5, first_group_5, column_5, group_5};
    end
    wire [LATE-1:0] late = lates[4*LATE-1 -: LATE];
    wire [COLUMN_BITS-1:0] winner_column = late[GROUP_BITS +: COLUMN_BITS] - FOUR;
    wire is_pixel = has_winners && column >= 7;

    stereo_search #(
        .DISPARITIES(DISPARITIES), .PARALLEL(PARALLEL), .SECOND_BEST(SECOND_BEST), .COLUMN_BITS(COLUMN_BITS),
        .GROUP_BITS(GROUP_BITS), .LEVELS(LEVELS), .AHEAD(AHEAD), .LATER(LATER)
    ) search (
        .clk(clk), .forgets(forgets), .begins(begins), .disparities(disparities),
        .least(least), .sums(sums), .valid(valids[7]), .column(winner_column), .group(late[GROUP_BITS-1:0]),
        .first_group(late[LATE-2]), .last_group(late[LATE-1]),
        .moves(valid && last_group && (is_pixel || drains)), .is_pixel(is_pixel),
        .is_first(row == 0 && column == 7), .is_last(column == width + SIX), .row(row[7:0]),
        .compares(1'b0), .pixels(16'b0), .record_valid(m_axis_tvalid), .record_ready(m_axis_tready), .record(m_axis_tdata),
        .record_first(m_axis_tuser), .record_last(m_axis_tlast), .go(go)
    );

    stereo_registers #(
        .WIDTH(WIDTH),
        .DISPARITIES(DISPARITIES),
        .PARALLEL(PARALLEL),
        .METHOD(METHOD),
        .SECOND_BEST(SECOND_BEST),
        .RADIUS_Y(RADIUS_Y),
        .COLUMN_BITS(COLUMN_BITS)
    ) registers (
        .clk(clk), .reset(reset), .bus_cycle(wb_cyc_i), .bus_strobe(wb_stb_i), .bus_write(wb_we_i),
        .bus_address(wb_adr_i), .bus_data(wb_dat_i), .bus_answer(wb_dat_o), .bus_ack(wb_ack_o),
        .enable(enable), .forget(forget), .set_width(set_width), .set_height(set_height),
        .set_disparities(set_disparities), .set_noise(set_noise), .set_least(set_least), .running(running),
        .begins(begins),
        .too_short(too_short), .too_long(too_long), .cut_off(cut_off),
        .aborts(aborts), .row_taken(m_axis_tvalid && m_axis_tready && m_axis_tlast)
    );
endmodule

`default_nettype wire
