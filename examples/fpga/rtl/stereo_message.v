// The message of the path down: what each disparity costs at the pixel that it goes to, over the cheapest way
// there.
//
// In: the path's costs at one pixel, PARALLEL in a clock, a group after the other. Out: while the next
// pixel's groups pass, the message to it of each group, with two registers between where HOLDS is 1,
//
//   min(q(d), q(d - 1) + step, q(d + 1) + step, least q + jump) - least q
//
// A cost of 127 is that of a disparity that is not searched; no other is over 104.
`default_nettype none

module stereo_message #(
    parameter PARALLEL = 64,
    parameter GROUPS = 1,
    parameter LEVELS = 6,
    parameter HOLDS = 0
) (
    input wire clk,
    input wire go,
    input wire valid,
    input wire first_group,
    input wire last_group,
    // The costs of this pixel's group, and what changes cost on the way to it.
    input wire [7*PARALLEL-1:0] costs,
    input wire [4:0] step,
    input wire [6:0] jump,
    // The message to this pixel's group.
    output wire [7*PARALLEL-1:0] message
);
    localparam LEAVES = 1 << LEVELS;
    localparam WORD = 7 * PARALLEL;
    localparam [6:0] NOT_SEARCHED = 127;

    // The groups of the last pixel and one before them, the newest in the lowest bits.
    // verilator lint_off UNUSEDSIGNAL
    reg [WORD*(GROUPS+1)-1:0] past;
    // verilator lint_on UNUSEDSIGNAL
    always @(posedge clk) if (go && valid) past <= {past[WORD*GROUPS-1:0], costs};

    // The least cost of the pixel as far as its groups are in, then of the whole pixel before.
    reg [7*(2*LEAVES-1)-1:0] nodes;
    integer k;
    always @* begin
        nodes = 0;
        nodes[7*LEAVES-1:0] = {7*LEAVES{1'b1}};
        nodes[WORD-1:0] = costs;
        // A node of the tree behind the leaves is the less of two before it.
        for (k = 0; k < LEAVES - 1; k = k + 1) begin
            nodes[7*(LEAVES+k) +: 7] = nodes[14*k+7 +: 7] < nodes[14*k +: 7]
                ? nodes[14*k+7 +: 7] : nodes[14*k +: 7];
        end
    end
    wire [6:0] root = nodes[7*(2*LEAVES-2) +: 7];
    reg [6:0] so_far;
    reg [6:0] of_last;
    wire [6:0] least = first_group ? so_far : of_last;
    always @(posedge clk) begin
        if (go && valid) begin
            so_far <= first_group || root < so_far ? root : so_far;
            if (first_group) of_last <= so_far;
        end
    end

    wire [WORD-1:0] here = past[WORD*(GROUPS-1) +: WORD];
    wire [6:0] before_first = first_group ? NOT_SEARCHED : past[WORD*(GROUPS+1)-1 -: 7];
    wire [6:0] after_last;
    generate
        if (GROUPS == 1) begin : one_group
            assign after_last = NOT_SEARCHED;
            // verilator lint_off UNUSEDSIGNAL
            wire unused = last_group;
            // verilator lint_on UNUSEDSIGNAL
        end else begin : groups
            assign after_last = last_group ? NOT_SEARCHED : past[WORD*(GROUPS-2) +: 7];
        end
    endgenerate

    // The first stage: the cheapest way but a jump. The second one: over the least cost, and a jump at most.
    // verilator lint_off UNUSEDSIGNAL
    wire [WORD+13:0] around = {after_last, here, before_first};
    // verilator lint_on UNUSEDSIGNAL
    wire [WORD-1:0] ways, ways_1, over;
    wire [6:0] jump_1, least_1;
    stereo_stage #(.BITS(WORD + 14), .HOLDS(HOLDS)) first_stage (
        .clk(clk), .go(go), .data({ways, jump, least}), .held({ways_1, jump_1, least_1})
    );
    stereo_stage #(.BITS(WORD), .HOLDS(HOLDS)) second_stage (
        .clk(clk), .go(go), .data(over), .held(message)
    );
    genvar i;
    generate
        for (i = 0; i < PARALLEL; i = i + 1) begin : lane
            wire [6:0] below = around[7*i +: 7];
            wire [6:0] above = around[7*(i+2) +: 7];
            wire [6:0] beside = below < above ? below : above;
            wire [7:0] near = {1'b0, beside} + {3'b0, step};
            wire [6:0] same = here[7*i +: 7];
            assign ways[7*i +: 7] = {1'b0, same} < near ? same : near[6:0];
            wire [6:0] moved = ways_1[7*i +: 7] - least_1;
            assign over[7*i +: 7] = moved < jump_1 ? moved : jump_1;
        end
    endgenerate
endmodule

`default_nettype wire
