// Winners of a stereo pair as its pixels come in, bit for bit those of the library's method `sgm`.
//
// Streams, records and registers are those of `stereo_block`. Each row is swept twice, so that a pixel
// takes two clocks with PARALLEL = DISPARITIES, and no pixel is taken in the second sweep: what feeds the
// stream holds a line. The stages, each a file beside those of `stereo_block`:
//
//   stereo_walk      the frame's way through lines and columns, and what is wrong with its stream
//   stereo_features  five rows around each column: gradients, brightness and census of both cameras
//   stereo_paths     costs, averaged down the columns, and their sums along three paths
//   stereo_search    winners and what their partners keep: records on their way out
//   stereo_registers size, search and status
//
// In step t line t comes in, row t - 2 has its costs, row t - 3 its path to the left, and row t - 4 its
// winners. A step takes 2 width + 8 columns. In column c of the first sweep features are those of column c
// - 5; the second sweep begins at column width + 8 of the step. Penalties are the library's own.
`default_nettype none

module stereo_sgm #(
    parameter WIDTH = 640,
    parameter DISPARITIES = 64,
    parameter PARALLEL = 64,
    parameter SECOND_BEST = 0
) (
    input wire clk,
    input wire reset,
    input wire [15:0] s_axis_tdata,
    input wire s_axis_tvalid,
    output wire s_axis_tready,
    input wire s_axis_tuser,
    input wire s_axis_tlast,
    output wire [63:0] m_axis_tdata,
    output wire m_axis_tvalid,
    input wire m_axis_tready,
    output wire m_axis_tuser,
    output wire m_axis_tlast,
    input wire wb_cyc_i,
    input wire wb_stb_i,
    input wire wb_we_i,
    input wire [5:2] wb_adr_i,
    input wire [31:0] wb_dat_i,
    output wire [31:0] wb_dat_o,
    output wire wb_ack_o
);
    localparam GROUPS = DISPARITIES / PARALLEL;
    localparam GROUP_BITS = GROUPS == 1 ? 1 : $clog2(GROUPS);
    localparam COLUMN_BITS = WIDTH < 250 ? 9 : $clog2(2 * WIDTH + 8);
    localparam ADDRESS_BITS = $clog2(WIDTH);
    localparam LEVELS = $clog2(PARALLEL);
    // Whether there are groups enough for registers in the paths.
    localparam HOLDS = GROUPS < 4 ? 0 : 1;
    // Clocks from the features to the sums, from the walk's token to them, and from the winner to the second
    // best.
    localparam PATHS = HOLDS == 0 ? 4 : 6;
    localparam AHEAD = 5 + PATHS;
    localparam LATER = SECOND_BEST == 0 ? 0 : GROUPS + LEVELS + 1;
    // Nothing is kept by the row that leaves a window.
    localparam CODE_BITS = $clog2(5 * WIDTH);

    wire go;
    wire enable, running, begins, aborts, too_short, too_long, cut_off;
    wire [COLUMN_BITS-1:0] set_width, width, column;
    wire [ADDRESS_BITS-1:0] next_column;
    wire [15:0] set_height, pixels, row;
    wire [7:0] set_disparities, disparities, set_least, least;
    wire [1:0] set_noise, noise;
    wire valid, first_group, last_group, inside_width, inside_height, first_line;
    wire first_code, enters, has_winners, has_last, drains;
    // verilator lint_off UNUSEDSIGNAL
    wire leaves;
    wire [CODE_BITS-1:0] code_row;
    // verilator lint_on UNUSEDSIGNAL
    wire [GROUP_BITS-1:0] group;
    wire forget;
    wire restarts = reset || forget;
    wire forgets = restarts || aborts;

    // Winners come two steps after their row's costs.
    stereo_walk #(
        .WIDTH(WIDTH),
        .DEPTH(AHEAD + LEVELS + LATER + 13),
        .GROUPS(GROUPS),
        .RADIUS_Y(2),
        .SWEEPS(2),
        .BEHIND(7),
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
        .leaves(leaves), .code_row(code_row), .has_winners(has_winners), .has_last(has_last), .row(row), .drains(drains)
    );

    wire [24:0] left;
    wire [29:0] right;
    wire [7:0] guide;
    wire [15:0] highest;

    stereo_features #(.WIDTH(WIDTH), .COLUMN_BITS(COLUMN_BITS), .ADDRESS_BITS(ADDRESS_BITS)) features (
        .clk(clk), .go(go), .noise(noise), .width(width), .next_column(next_column), .valid(valid),
        .pixels(pixels), .column(column), .first_group(first_group), .inside_width(inside_width),
        .inside_height(inside_height), .first_line(first_line), .left(left), .right(right), .guide(guide), .highest(highest)
    );

    // Where the sweeps are.
    localparam [COLUMN_BITS-1:0] ONE = 1;
    localparam [COLUMN_BITS-1:0] TWO = 2;
    localparam [COLUMN_BITS-1:0] FOUR = 4;
    localparam [COLUMN_BITS-1:0] FIVE = 5;
    localparam [COLUMN_BITS-1:0] SEVEN = 7;
    localparam [COLUMN_BITS-1:0] EIGHT = 8;
    wire is_back = column >= width + EIGHT;
    wire is_forth = column >= FIVE && column < width + FIVE;
    wire [COLUMN_BITS-1:0] at = is_back ? (width << 1) + SEVEN - column : column - FIVE;
    wire is_first = column == FIVE || column == width + EIGHT;
    wire [COLUMN_BITS-1:0] last = width - ONE;
    wire [COLUMN_BITS-1:0] ahead = column - TWO < last ? column - TWO : last;
    wire [2:0] behind = column < 6 ? 3'd0 : column[2:0] - 3'd6;

    // The token beside the features.
    localparam TOKEN = 2 * COLUMN_BITS + GROUP_BITS + 11;
    reg [5*TOKEN-1:0] tokens;
    reg [AHEAD-1:0] valids;
    always @(posedge clk) begin
        if (go) begin
            tokens <= {
                tokens[4*TOKEN-1:0], at, ahead, group, behind, first_group, last_group, is_back || is_forth,
                is_back, is_first, first_code, enters, row == 0
            };
        end
        if (forgets) valids <= 0;
        else if (go) valids <= {valids[AHEAD-2:0], valid && !drains};
    end
    wire [COLUMN_BITS-1:0] at_5, ahead_5;
    wire [GROUP_BITS-1:0] group_5;
    wire [2:0] behind_5;
    wire first_group_5, last_group_5, inside_5, back_5, first_5, first_code_5, enters_5, first_row_5;
    assign {
        at_5, ahead_5, group_5, behind_5, first_group_5, last_group_5, inside_5, back_5, first_5,
        first_code_5, enters_5, first_row_5
    } = tokens[5*TOKEN-1 -: TOKEN];

    wire [8*PARALLEL-1:0] sums;
    stereo_paths #(
        .WIDTH(WIDTH), .DISPARITIES(DISPARITIES), .PARALLEL(PARALLEL), .GROUPS(GROUPS), .LEVELS(LEVELS),
        .HOLDS(HOLDS), .COLUMN_BITS(COLUMN_BITS), .GROUP_BITS(GROUP_BITS)
    ) paths (
        .clk(clk), .reset(forgets), .go(go), .disparities(disparities), .least(least),
        .read_column(tokens[4*TOKEN-1 -: COLUMN_BITS]), .valid(valids[4]), .column(at_5), .group(group_5),
        .first_group(first_group_5), .last_group(last_group_5), .is_inside(inside_5), .is_back(back_5),
        .is_first(first_5), .ahead(ahead_5), .behind(behind_5), .begins_average(first_code_5),
        .enters(enters_5), .begins_paths(first_row_5), .left(left), .right(right), .guide(guide), .sums(sums)
    );

    // The token beside the sums.
    localparam LATE = 3 + COLUMN_BITS + GROUP_BITS;
    reg [PATHS*LATE-1:0] lates;
    always @(posedge clk) begin
        if (go) begin
            lates <= {
                lates[(PATHS-1)*LATE-1:0], inside_5 && !back_5, last_group_5, first_group_5, at_5, group_5
            };
        end
    end
    wire [LATE-1:0] late = lates[PATHS*LATE-1 -: LATE];

    stereo_search #(
        .DISPARITIES(DISPARITIES), .PARALLEL(PARALLEL), .SECOND_BEST(SECOND_BEST), .COLUMN_BITS(COLUMN_BITS),
        .GROUP_BITS(GROUP_BITS), .LEVELS(LEVELS), .AHEAD(AHEAD), .LATER(LATER), .COMPARES(1)
    ) search (
        .clk(clk), .forgets(forgets), .begins(begins), .disparities(disparities), .least(least),
        .sums(sums), .valid(valids[AHEAD-1] && late[LATE-1]), .column(late[GROUP_BITS +: COLUMN_BITS]),
        .group(late[GROUP_BITS-1:0]), .first_group(late[LATE-3]), .last_group(late[LATE-2]),
        // The second sweep brings the row's last winners out of the left-right check.
        .moves(valid && last_group), .is_pixel(has_winners && is_forth),
        .is_first(row == 0 && column == FIVE), .is_last(column == width + FOUR), .row(row[7:0]),
        .compares(noise == 0 && !has_last), .pixels(highest),
        .record_valid(m_axis_tvalid), .record_ready(m_axis_tready), .record(m_axis_tdata),
        .record_first(m_axis_tuser), .record_last(m_axis_tlast), .go(go)
    );

    stereo_registers #(
        .WIDTH(WIDTH),
        .DISPARITIES(DISPARITIES),
        .PARALLEL(PARALLEL),
        .METHOD(2),
        .SECOND_BEST(SECOND_BEST),
        .RADIUS_Y(1),
        .COLUMN_BITS(COLUMN_BITS)
    ) registers (
        .clk(clk), .reset(reset), .bus_cycle(wb_cyc_i), .bus_strobe(wb_stb_i), .bus_write(wb_we_i),
        .bus_address(wb_adr_i), .bus_data(wb_dat_i), .bus_answer(wb_dat_o), .bus_ack(wb_ack_o),
        .enable(enable), .forget(forget), .set_width(set_width), .set_height(set_height),
        .set_disparities(set_disparities), .set_noise(set_noise), .set_least(set_least), .running(running),
        .begins(begins), .too_short(too_short), .too_long(too_long), .cut_off(cut_off),
        .aborts(aborts), .row_taken(m_axis_tvalid && m_axis_tready && m_axis_tlast)
    );
endmodule

`default_nettype wire
