// Sums along three paths, for one row in two sweeps.
//
// The first sweep runs to the right while the features of a row come in. It brings the average of the
// costs down the columns to that row, and finishes the row above it: to what the path to the left had
// there, it adds the path to the right and the one down. The second sweep runs to the left over the
// averages, with the same gates as the path to the right, and leaves that path's costs. In memory, for
// each column and disparity: the average of costs in 5 bits, the path to the left and the path down in 7;
// for each column three rows of the left image.
//
// A token has the column's features; a clock later its costs are made, two clocks later they are there and
// its paths begin. With four groups and more, these have two registers that fewer have not (HOLDS): three
// or five clocks later its paths are there, a clock after that its sums. Messages down are made of costs two
// columns to both sides in the row above: those are read three columns ahead.
`default_nettype none

module stereo_paths #(
    parameter WIDTH = 640,
    parameter DISPARITIES = 64,
    parameter PARALLEL = 64,
    parameter GROUPS = 1,
    parameter LEVELS = 6,
    parameter HOLDS = 0,
    parameter COLUMN_BITS = 11,
    parameter GROUP_BITS = 1
) (
    input wire clk,
    input wire reset,
    input wire go,
    input wire [7:0] disparities,
    input wire [7:0] least,
    // The column of the clock before's token.
    input wire [COLUMN_BITS-1:0] read_column,
    // The token: a column of the row, in the first or the second sweep; whether it is the first of its sweep;
    // the columns three ahead and one behind for the path down; whether averages begin with this row, whether
    // it is inside of the image, and whether the row that is finished is the image's first.
    input wire valid,
    input wire [COLUMN_BITS-1:0] column,
    input wire [GROUP_BITS-1:0] group,
    input wire first_group,
    input wire last_group,
    input wire is_inside,
    input wire is_back,
    input wire is_first,
    // verilator lint_off UNUSEDSIGNAL
    // A column's place has fewer bits.
    input wire [COLUMN_BITS-1:0] ahead,
    // verilator lint_on UNUSEDSIGNAL
    input wire [2:0] behind,
    input wire begins_average,
    input wire enters,
    input wire begins_paths,
    input wire [24:0] left,
    input wire [29:0] right,
    input wire [7:0] guide,
    // Four clocks later, or six with HOLDS: the sums of the group, a byte each.
    output reg [8*PARALLEL-1:0] sums
);
    localparam PLACE_BITS = $clog2(WIDTH);
    localparam PLACES = GROUPS == 1 ? WIDTH : WIDTH << GROUP_BITS;
    localparam ADDRESS_BITS = $clog2(PLACES);
    localparam RING = GROUPS == 1 ? 8 : 8 << GROUP_BITS;
    localparam RING_BITS = $clog2(RING);
    localparam WORD = 7 * PARALLEL;
    localparam [6:0] NOT_SEARCHED = 127;
    localparam [4:0] NO_COST = 31;
    // The clock in which paths go out, counted from the token.
    localparam OUT = HOLDS == 0 ? 2 : 4;

    // The token one, two and more clocks later.
    reg [OUT:0] valids;
    // verilator lint_off UNUSEDSIGNAL
    reg [COLUMN_BITS-1:0] column_1, column_2;
    // verilator lint_on UNUSEDSIGNAL
    reg [GROUP_BITS-1:0] group_1, group_2;
    reg [5:0] flags_1;
    reg [5:0] flags_2;
    reg first_group_1, first_group_2, last_group_1, last_group_2;
    reg writes_down, writes_left;
    reg [ADDRESS_BITS-1:0] written_place;
    reg [7:0] guide_1;
    wire [5:0] flags = {is_inside, is_back, is_first, begins_average, enters, begins_paths};
    wire inside_1, back_1, inside_2, back_2, first_2, begins_average_2, enters_2, begins_paths_2;
    assign {inside_1, back_1} = flags_1[5:4];
    assign {inside_2, back_2, first_2, begins_average_2, enters_2, begins_paths_2} = flags_2;

    // Places in memory: of a column and group.
    wire [ADDRESS_BITS-1:0] place_ahead, place_1, place_2, place_out;
    wire [RING_BITS-1:0] ring_behind, ring_ahead_1;
    reg [2:0] ahead_1;
    generate
        if (GROUPS == 1) begin : one_group
            assign place_ahead = ahead[PLACE_BITS-1:0];
            assign place_1 = column_1[PLACE_BITS-1:0];
            assign place_2 = column_2[PLACE_BITS-1:0];
            assign ring_behind = behind;
            assign ring_ahead_1 = ahead_1;
            // verilator lint_off UNUSEDSIGNAL
            wire unused = group_2[0];
            // verilator lint_on UNUSEDSIGNAL
        end else begin : groups
            assign place_ahead = {ahead[PLACE_BITS-1:0], group};
            assign place_1 = {column_1[PLACE_BITS-1:0], group_1};
            assign place_2 = {column_2[PLACE_BITS-1:0], group_2};
            assign ring_behind = {behind, group};
            assign ring_ahead_1 = {ahead_1, group_1};
        end
    endgenerate

    always @(posedge clk) begin
        if (reset) valids <= 0;
        else if (go) valids <= {valids[OUT-1:0], valid};
        if (go) begin
            {column_1, group_1, first_group_1, last_group_1} <= {column, group, first_group, last_group};
            {column_2, group_2, first_group_2, last_group_2} <=
                {column_1, group_1, first_group_1, last_group_1};
            flags_1 <= flags;
            flags_2 <= flags_1;
            ahead_1 <= ahead[2:0];
            guide_1 <= guide;
            written_place <= place_out;
            writes_down <= inside_out && !back_out;
            writes_left <= inside_out && back_out;
        end
    end

    // The token when its paths go out.
    localparam TOKEN = ADDRESS_BITS + 3;
    wire [TOKEN-1:0] token_3;
    wire inside_out, back_out, begins_paths_out;
    stereo_stage #(.BITS(TOKEN), .HOLDS(HOLDS)) token_stage (
        .clk(clk), .go(go), .data({place_2, inside_2, back_2, begins_paths_2}), .held(token_3)
    );
    stereo_stage #(.BITS(TOKEN), .HOLDS(HOLDS)) token_stage_out (
        .clk(clk), .go(go), .data(token_3), .held({place_out, inside_out, back_out, begins_paths_out})
    );

    // Costs, and their averages: those up to the row above, and with this row.
    wire [5*PARALLEL-1:0] costs;
    stereo_cost #(
        .DISPARITIES(DISPARITIES), .PARALLEL(PARALLEL), .GROUPS(GROUPS), .COLUMN_BITS(COLUMN_BITS),
        .GROUP_BITS(GROUP_BITS)
    ) cost (
        .clk(clk), .go(go), .least(least), .read_column(read_column),
        .take(valid && first_group && is_inside && !is_back), .column(column), .left(left), .right(right),
        .group(group_1), .costs(costs)
    );
    wire [5*PARALLEL-1:0] averages;
    wire [5*PARALLEL-1:0] next_averages;
    stereo_ram #(.BITS(5 * PARALLEL), .DEPTH(PLACES)) average_memory (
        .clk(clk), .read(go), .read_address(place_1), .read_data(averages),
        .write(go && valids[1] && inside_2 && !back_2), .write_address(place_2), .write_data(next_averages)
    );

    // Rows of the left image: in the first sweep the row above the one whose features come, the one whose
    // sums are made and the one above that; in the second they have moved on by one.
    wire [23:0] guides;
    stereo_ram #(.BITS(24), .DEPTH(WIDTH)) guide_memory (
        .clk(clk), .read(go), .read_address(column[PLACE_BITS-1:0]), .read_data(guides),
        .write(go && valids[0] && last_group_1 && inside_1 && !back_1),
        .write_address(column_1[PLACE_BITS-1:0]), .write_data({guides[15:0], guide_1})
    );

    // By how much the brightness changes on the way to this pixel: 0 little, 1 more, 2 much.
    function [1:0] change;
        input [7:0] a;
        input [7:0] b;
        reg [7:0] apart;
        begin
            apart = a > b ? a - b : b - a;
            change = apart < 6 ? 2'd0 : apart < 12 ? 2'd1 : 2'd2;
        end
    endfunction

    reg [7:0] last_guide;
    reg [1:0] along_change, down_change;
    always @(posedge clk) begin
        if (go) begin
            along_change <= change(guides[15:8], last_guide);
            down_change <= change(guides[15:8], guides[23:16]);
            if (valids[0] && last_group_1) last_guide <= guides[15:8];
        end
    end

    // The path down, in the row above: three columns ahead, and one column behind from a ring.
    wire [WORD-1:0] down_ahead, down_behind;
    reg [WORD-1:0] down_made;
    reg [WORD-1:0] down_average;
    stereo_ram #(.BITS(WORD), .DEPTH(PLACES)) down_memory (
        .clk(clk), .read(go), .read_address(place_ahead), .read_data(down_ahead),
        .write(go && valids[OUT] && writes_down), .write_address(written_place), .write_data(down_made)
    );
    stereo_ram #(.BITS(WORD), .DEPTH(RING)) down_ring (
        .clk(clk), .read(go), .read_address(ring_behind), .read_data(down_behind),
        .write(go && valids[0] && !back_1), .write_address(ring_ahead_1), .write_data(down_ahead)
    );

    // Paths along the line, in either direction, and down.
    wire [5*PARALLEL-1:0] own, own_out;
    wire [WORD-1:0] along, down, down_message;
    reg [WORD-1:0] along_made;
    stereo_along #(
        .PARALLEL(PARALLEL), .GROUPS(GROUPS), .GROUP_BITS(GROUP_BITS), .LEVELS(LEVELS), .HOLDS(HOLDS)
    ) along_path (
        .clk(clk), .go(go), .valid(valids[1]), .valid_out(valids[OUT-1]), .group(group_2),
        .last_group(last_group_2), .first_group(first_group_2), .is_first(first_2), .costs(own),
        .step(along_change == 0 ? 5'd18 : 5'd9),
        .jump(along_change == 0 ? 7'd88 : along_change == 1 ? 7'd28 : 7'd16), .costs_out(own_out),
        .path(along)
    );
    stereo_message #(.PARALLEL(PARALLEL), .GROUPS(GROUPS), .LEVELS(LEVELS), .HOLDS(HOLDS)) down_path (
        .clk(clk), .go(go), .valid(valids[1]), .first_group(first_group_2), .last_group(last_group_2),
        .costs(down_average), .step(down_change == 0 ? 5'd18 : 5'd9),
        .jump(down_change == 0 ? 7'd88 : down_change == 1 ? 7'd28 : 7'd16), .message(down_message)
    );

    // The path to the left, as the second sweep left it.
    wire [WORD-1:0] leftward;
    stereo_ram #(.BITS(WORD), .DEPTH(PLACES)) left_memory (
        .clk(clk), .read(go), .read_address(place_out), .read_data(leftward),
        .write(go && valids[OUT] && writes_left), .write_address(written_place), .write_data(along_made)
    );

    genvar i;
    generate
        for (i = 0; i < PARALLEL; i = i + 1) begin : lane
            wire [4:0] average = averages[5*i +: 5];
            // verilator lint_off UNUSEDSIGNAL
            wire [5:0] twice = {1'b0, begins_average_2 ? 5'd0 : average} + {1'b0, costs[5*i +: 5]} + 6'd1;
            wire [7:0] both = {1'b0, down_ahead[7*i +: 7]} + {1'b0, down_behind[7*i +: 7]};
            // verilator lint_on UNUSEDSIGNAL
            assign next_averages[5*i +: 5] = enters_2 ? twice[5:1] : average;
            always @(posedge clk) if (go) down_average[7*i +: 7] <= both[7:1];

            wire [7:0] disparity;
            if (GROUPS == 1) begin : alone
                assign disparity = i[7:0];
            end else begin : one_of_many
                assign disparity = group_2 * PARALLEL[7:0] + i[7:0];
            end
            assign own[5*i +: 5] = disparity >= disparities ? NO_COST : average;
            wire [4:0] cost_out = own_out[5*i +: 5];
            assign down[7*i +: 7] = cost_out == NO_COST ? NOT_SEARCHED
                : {2'b0, cost_out} + (begins_paths_out ? 7'd0 : down_message[7*i +: 7]);
            wire [8:0] sum = {2'b0, along_made[7*i +: 7]} + {2'b0, down_made[7*i +: 7]}
                + {2'b0, leftward[7*i +: 7]};
            always @(posedge clk) if (go) sums[8*i +: 8] <= sum[8] ? 8'd255 : sum[7:0];
        end
    endgenerate
    always @(posedge clk) if (go) {along_made, down_made} <= {along, down};
endmodule

`default_nettype wire
