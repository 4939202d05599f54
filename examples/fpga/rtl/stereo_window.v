// Costs of all candidates over the window: Hamming distances, summed down the columns, then along the row.
//
// Each column keeps its sum for every candidate in block RAM: the row that enters the window below adds its
// distances and the one that leaves it above takes its own away. A column counts in units of 2^SHIFT bits,
// the rest is left out; the window adds nine columns, those outside of the image nothing.
//
// Token in: beside the codes, in the clock after that of `read_*`. Sums out: four clocks
// later, of the window around column x - 4.
`default_nettype none

module stereo_window #(
    parameter WIDTH = 640,
    parameter DISPARITIES = 64,
    parameter PARALLEL = 64,
    parameter GROUPS = 1,
    parameter RADIUS_Y = 4,
    parameter BITS = 8,
    parameter SUM_BITS = 7,
    parameter SHIFT = 2,
    parameter COLUMN_BITS = 11,
    parameter GROUP_BITS = 1,
    parameter CODE_BITS = 13
) (
    input wire clk,
    input wire reset,
    input wire go,
    // The smallest disparity.
    input wire [7:0] least,
    // The token of the clock before, whose codes come next.
    input wire [CODE_BITS-1:0] read_code,
    input wire [COLUMN_BITS-1:0] read_column,
    // The token and its codes.
    input wire valid,
    input wire [COLUMN_BITS-1:0] column,
    // verilator lint_off UNUSEDSIGNAL
    // A single group has no number.
    input wire [GROUP_BITS-1:0] group,
    // verilator lint_on UNUSEDSIGNAL
    input wire first_group,
    input wire in_image,
    input wire first_code,
    input wire enters,
    input wire leaves,
    input wire [CODE_BITS-1:0] code_address,
    input wire [BITS-1:0] left_code,
    input wire [BITS-1:0] right_code,
    // A byte for each candidate of the group.
    output reg [8*PARALLEL-1:0] sums
);
    localparam [SUM_BITS-1:0] NOTHING = 0;
    localparam UNIT_BITS = SUM_BITS - SHIFT;
    localparam [UNIT_BITS-1:0] NO_UNITS = 0;
    localparam PLACE_BITS = $clog2(WIDTH);
    // Each column has places for a power of two of groups.
    localparam PLACES = GROUPS == 1 ? WIDTH : WIDTH << GROUP_BITS;
    localparam ADDRESS_BITS = $clog2(PLACES);
    localparam DELAY = 9 * GROUPS;
    localparam DELAY_BITS = $clog2(DELAY);
    localparam [DELAY_BITS-1:0] ONE_DELAY = 1;
    localparam [DELAY_BITS-1:0] LAST_DELAY = DELAY[DELAY_BITS-1:0] - ONE_DELAY;

    // The codes of the row that leaves the window, where those of the row that enters it go.
    wire [2*BITS-1:0] old_codes;
    stereo_ram #(.BITS(2 * BITS), .DEPTH((2 * RADIUS_Y + 1) * WIDTH)) codes (
        .clk(clk),
        .read(go),
        .read_address(read_code),
        .read_data(old_codes),
        .write(go && valid && first_group && in_image && enters),
        .write_address(code_address),
        .write_data({right_code, left_code})
    );

    // The codes of both rows: the column's left ones, and those of its partners.
    wire takes = valid && first_group && in_image;
    reg [BITS-1:0] left_in;
    reg [BITS-1:0] left_out;
    wire [BITS*DISPARITIES-1:0] right_in;
    wire [BITS*DISPARITIES-1:0] right_out;
    always @(posedge clk) if (go && takes) {left_in, left_out} <= {left_code, old_codes[BITS-1:0]};
    stereo_partners #(.BITS(BITS), .DISPARITIES(DISPARITIES), .COLUMN_BITS(COLUMN_BITS)) partners_in (
        .clk(clk), .go(go), .least(least), .read_column(read_column), .take(takes), .column(column),
        .value(right_code), .partners(right_in)
    );
    stereo_partners #(.BITS(BITS), .DISPARITIES(DISPARITIES), .COLUMN_BITS(COLUMN_BITS)) partners_out (
        .clk(clk), .go(go), .least(least), .read_column(read_column), .take(takes), .column(column),
        .value(old_codes[2*BITS-1:BITS]), .partners(right_out)
    );

    // The token beside the codes (1), beside the distances and the old sums (2), beside the columns (3).
    reg valid_1, valid_2, valid_3;
    reg inside_1, inside_2;
    reg [COLUMN_BITS-1:0] column_1, column_2, column_3;
    reg first_code_1, first_code_2;
    reg enters_1, leaves_1;

    always @(posedge clk) begin
        if (reset) begin
            valid_1 <= 1'b0;
            valid_2 <= 1'b0;
            valid_3 <= 1'b0;
        end else if (go) begin
            valid_1 <= valid;
            valid_2 <= valid_1;
            valid_3 <= valid_2;
        end
        if (go) begin
            {inside_1, column_1} <= {in_image, column};
            {inside_2, column_2} <= {inside_1, column_1};
            column_3 <= column_2;
            {first_code_1, enters_1, leaves_1} <= {first_code, enters, leaves};
            first_code_2 <= first_code_1;
        end
    end

    // What a group has of its own: the places of its sums, its codes, and its last sums over the window.
    wire [ADDRESS_BITS-1:0] address;
    wire [ADDRESS_BITS-1:0] address_2;
    wire [BITS*PARALLEL-1:0] group_in;
    wire [BITS*PARALLEL-1:0] group_out;
    wire [8*PARALLEL-1:0] last_sums;
    wire [8*PARALLEL-1:0] next_sums;
    generate
        if (GROUPS == 1) begin : one_group
            assign address = column[PLACE_BITS-1:0];
            assign address_2 = column_2[PLACE_BITS-1:0];
            assign group_in = right_in;
            assign group_out = right_out;
            assign last_sums = sums;
        end else begin : groups
            reg [GROUP_BITS-1:0] group_1, group_2, group_3;
            reg [8*PARALLEL-1:0] kept [0:GROUPS-1];
            assign address = {column[PLACE_BITS-1:0], group};
            assign address_2 = {column_2[PLACE_BITS-1:0], group_2};
            assign group_in = right_in[group_1 * BITS * PARALLEL +: BITS * PARALLEL];
            assign group_out = right_out[group_1 * BITS * PARALLEL +: BITS * PARALLEL];
            assign last_sums = kept[group_3];
            always @(posedge clk) begin
                if (go) {group_1, group_2, group_3} <= {group, group_1, group_2};
                if (go && valid_3) kept[group_3] <= next_sums;
            end
        end
    endgenerate

    // Read a clock ahead, for block RAM is slow to answer.
    wire [SUM_BITS*PARALLEL-1:0] read_sums;
    reg [SUM_BITS*PARALLEL-1:0] old_sums;
    always @(posedge clk) if (go) old_sums <= read_sums;
    wire [SUM_BITS*PARALLEL-1:0] new_sums;
    stereo_ram #(.BITS(SUM_BITS * PARALLEL), .DEPTH(PLACES)) columns (
        .clk(clk),
        .read(go),
        .read_address(address),
        .read_data(read_sums),
        .write(go && valid_2 && inside_2),
        .write_address(address_2),
        .write_data(new_sums)
    );

    // The columns' units of the last nine columns, and the sums over them of each group.
    reg [DELAY_BITS-1:0] turn;
    reg [DELAY_BITS-1:0] turn_2, turn_3;
    wire [UNIT_BITS*PARALLEL-1:0] read_units;
    reg [UNIT_BITS*PARALLEL-1:0] oldest;
    reg [UNIT_BITS*PARALLEL-1:0] units;
    stereo_ram #(.BITS(UNIT_BITS * PARALLEL), .DEPTH(DELAY)) delay (
        .clk(clk),
        .read(go),
        .read_address(turn),
        .read_data(read_units),
        .write(go && valid_3),
        .write_address(turn_3),
        .write_data(units)
    );

    always @(posedge clk) begin
        if (reset) begin
            turn <= 0;
        end else if (go && valid_1) begin
            turn <= turn == LAST_DELAY ? {DELAY_BITS{1'b0}} : turn + ONE_DELAY;
        end
        if (go) begin
            turn_2 <= turn;
            turn_3 <= turn_2;
            oldest <= read_units;
        end
    end

    always @(posedge clk) if (go && valid_3) sums <= next_sums;

    function [3:0] ones;
        input [7:0] bits;
        ones = {3'b0, bits[0]} + {3'b0, bits[1]} + {3'b0, bits[2]} + {3'b0, bits[3]}
            + {3'b0, bits[4]} + {3'b0, bits[5]} + {3'b0, bits[6]} + {3'b0, bits[7]};
    endfunction

    genvar i;
    generate
        for (i = 0; i < PARALLEL; i = i + 1) begin : lane
            wire [7:0] apart_in = {{(8-BITS){1'b0}}, left_in ^ group_in[BITS*i +: BITS]};
            wire [7:0] apart_out = {{(8-BITS){1'b0}}, left_out ^ group_out[BITS*i +: BITS]};
            // The change of the column's sum, in two's complement: all but its sign fits SUM_BITS.
            reg [SUM_BITS-1:0] change;
            wire [SUM_BITS-1:0] comes = {{(SUM_BITS-4){1'b0}}, ones(apart_in)};
            wire [SUM_BITS-1:0] goes = {{(SUM_BITS-4){1'b0}}, ones(apart_out)};
            always @(posedge clk) begin
                if (go) change <= (enters_1 ? comes : NOTHING) - (leaves_1 ? goes : NOTHING);
            end

            wire [SUM_BITS-1:0] old = first_code_2 ? NOTHING : old_sums[SUM_BITS*i +: SUM_BITS];
            wire [SUM_BITS-1:0] sum = old + change;
            assign new_sums[SUM_BITS*i +: SUM_BITS] = sum;
            always @(posedge clk) begin
                if (go) units[UNIT_BITS*i +: UNIT_BITS] <= inside_2 ? sum[SUM_BITS-1:SHIFT] : NO_UNITS;
            end

            wire [7:0] last = column_3 == 0 ? 8'd0 : last_sums[8*i +: 8];
            wire [7:0] plus = {{(8-UNIT_BITS){1'b0}}, units[UNIT_BITS*i +: UNIT_BITS]};
            wire [7:0] minus = {{(8-UNIT_BITS){1'b0}}, oldest[UNIT_BITS*i +: UNIT_BITS]};
            assign next_sums[8*i +: 8] = last + plus - (column_3 < 9 ? 8'd0 : minus);
        end
    endgenerate
endmodule

`default_nettype wire
