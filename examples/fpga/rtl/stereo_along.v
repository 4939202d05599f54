// The path along a line: what each disparity costs at a pixel, with the cheapest way there.
//
// In: costs c of a pixel, PARALLEL in a clock, a group after the other. Out, with two registers between
// where HOLDS is 1: the path's costs q of the group, from those p of the pixel before it,
//
//   q(d) = c(d) + min(p(d), p(d - 1) + step, p(d + 1) + step, least p + jump) - least p
//        = min(c(d) + min(p(d), p(d - 1) + step, p(d + 1) + step) - least p, c(d) + jump)
//
// and c(d) at a line's first pixel. As the second form says, least p is needed last: the least q of a group
// is known two clocks after it comes in, in time for the next pixel, whose first group gets there as many
// clocks after its own beginning. With registers, a pixel has four groups at least: then those of the pixel
// before are known when they are looked at.
//
// A cost c of 31 is that of a disparity that is not searched: its q is 127. No other c is over 16, no other q
// over 104.
`default_nettype none

module stereo_along #(
    parameter PARALLEL = 64,
    parameter GROUPS = 1,
    parameter GROUP_BITS = 1,
    parameter LEVELS = 6,
    parameter HOLDS = 0
) (
    input wire clk,
    input wire go,
    // Whether there is a group that comes in, and one that goes out.
    input wire valid,
    input wire valid_out,
    // verilator lint_off UNUSEDSIGNAL
    // A single group has no number, and is the last.
    input wire [GROUP_BITS-1:0] group,
    input wire last_group,
    // verilator lint_on UNUSEDSIGNAL
    input wire first_group,
    input wire is_first,
    input wire [5*PARALLEL-1:0] costs,
    // What changes cost on the way to this pixel.
    input wire [4:0] step,
    input wire [6:0] jump,
    // The group that goes out: its costs as they came in, and the path's.
    output wire [5*PARALLEL-1:0] costs_out,
    output wire [7*PARALLEL-1:0] path
);
    localparam LEAVES = 1 << LEVELS;
    localparam WORD = 7 * PARALLEL;
    localparam [6:0] NOT_SEARCHED = 127;
    localparam [4:0] NO_COST = 31;

    // The path's costs of the last pixel: those of this group, and one to each side.
    wire [WORD-1:0] here;
    wire [6:0] after_last;
    reg [6:0] last_here;
    wire [6:0] before_first = first_group ? NOT_SEARCHED : last_here;
    always @(posedge clk) if (go && valid) last_here <= here[WORD-1 -: 7];

    wire [GROUP_BITS-1:0] group_out;
    generate
        if (GROUPS == 1) begin : one_group
            reg [WORD-1:0] past;
            always @(posedge clk) if (go && valid_out) past <= path;
            assign here = past;
            assign after_last = NOT_SEARCHED;
            // verilator lint_off UNUSEDSIGNAL
            wire unused = group_out[0];
            // verilator lint_on UNUSEDSIGNAL
        end else begin : groups
            reg [WORD-1:0] past [0:GROUPS-1];
            reg [6:0] firsts [0:GROUPS-1];
            wire [GROUP_BITS-1:0] next_group = group + 1'b1;
            always @(posedge clk) begin
                if (go && valid_out) begin
                    past[group_out] <= path;
                    firsts[group_out] <= path[6:0];
                end
            end
            assign here = past[group];
            assign after_last = last_group ? NOT_SEARCHED : firsts[next_group];
        end
    endgenerate

    // The first stage: the cheapest way to each disparity but a jump, and its cost.
    // verilator lint_off UNUSEDSIGNAL
    wire [WORD+13:0] around = {after_last, here, before_first};
    // verilator lint_on UNUSEDSIGNAL
    wire [WORD-1:0] ways;
    genvar i;
    generate
        for (i = 0; i < PARALLEL; i = i + 1) begin : way
            wire [6:0] below = around[7*i +: 7];
            wire [6:0] above = around[7*(i+2) +: 7];
            wire [6:0] beside = below < above ? below : above;
            wire [7:0] near = {1'b0, beside} + {3'b0, step};
            wire [6:0] same = here[7*i +: 7];
            wire [6:0] moved = {1'b0, same} < near ? same : near[6:0];
            wire [4:0] own = costs[5*i +: 5];
            assign ways[7*i +: 7] =
                own == NO_COST ? NOT_SEARCHED : {2'b0, own} + (is_first ? 7'd0 : moved);
        end
    endgenerate
    wire [WORD-1:0] ways_1, ways_2;
    wire [5*PARALLEL-1:0] costs_1;
    wire [6:0] jump_1;
    wire [GROUP_BITS-1:0] group_1;
    wire first_group_1, first_1, first_group_2, first_2;
    stereo_stage #(.BITS(12 * PARALLEL + GROUP_BITS + 9), .HOLDS(HOLDS)) first_stage (
        .clk(clk), .go(go), .data({ways, costs, jump, group, first_group, is_first}),
        .held({ways_1, costs_1, jump_1, group_1, first_group_1, first_1})
    );

    // The second stage: the least of the group, of both. A node of a tree behind the leaves is the less of
    // two before it.
    reg [7*(2*LEAVES-1)-1:0] nodes;
    reg [5*(2*LEAVES-1)-1:0] cost_nodes;
    integer k;
    always @* begin
        nodes = 0;
        nodes[7*LEAVES-1:0] = {7*LEAVES{1'b1}};
        nodes[WORD-1:0] = ways_1;
        cost_nodes = 0;
        cost_nodes[5*LEAVES-1:0] = {5*LEAVES{1'b1}};
        cost_nodes[5*PARALLEL-1:0] = costs_1;
        for (k = 0; k < LEAVES - 1; k = k + 1) begin
            nodes[7*(LEAVES+k) +: 7] = nodes[14*k+7 +: 7] < nodes[14*k +: 7]
                ? nodes[14*k+7 +: 7] : nodes[14*k +: 7];
            cost_nodes[5*(LEAVES+k) +: 5] = cost_nodes[10*k+5 +: 5] < cost_nodes[10*k +: 5]
                ? cost_nodes[10*k+5 +: 5] : cost_nodes[10*k +: 5];
        end
    end
    wire [6:0] least_way = nodes[7*(2*LEAVES-2) +: 7];
    wire [6:0] least_far = {2'b0, cost_nodes[5*(2*LEAVES-2) +: 5]} + jump_1;
    wire [6:0] least_way_2, least_far_2;
    wire [6:0] jump_2;
    stereo_stage #(.BITS(12 * PARALLEL + GROUP_BITS + 23), .HOLDS(HOLDS)) second_stage (
        .clk(clk), .go(go),
        .data({ways_1, costs_1, jump_1, group_1, first_group_1, first_1, least_way, least_far}),
        .held({ways_2, costs_out, jump_2, group_out, first_group_2, first_2, least_way_2, least_far_2})
    );

    // The third stage: jumps, and the least of the pixel as far as its groups are out, then of the whole
    // pixel before.
    reg [6:0] so_far;
    reg [6:0] of_last;
    wire [6:0] least = first_2 ? 7'd0 : first_group_2 ? so_far : of_last;
    wire is_empty = costs_out[4:0] == NO_COST;
    wire [6:0] over_least = least_way_2 - least;
    wire [6:0] root = is_empty ? NOT_SEARCHED : over_least < least_far_2 ? over_least : least_far_2;
    always @(posedge clk) begin
        if (go && valid_out) begin
            so_far <= first_group_2 || root < so_far ? root : so_far;
            if (first_group_2) of_last <= so_far;
        end
    end
    generate
        for (i = 0; i < PARALLEL; i = i + 1) begin : lane
            wire [6:0] over = ways_2[7*i +: 7] - least;
            wire [4:0] own = costs_out[5*i +: 5];
            wire [6:0] far = {2'b0, own} + jump_2;
            assign path[7*i +: 7] = own == NO_COST ? NOT_SEARCHED : over < far ? over : far;
        end
    endgenerate
endmodule

`default_nettype wire
