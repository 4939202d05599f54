// Winner-take-all: the cheapest candidate of each pixel, of equals that of the smallest disparity, with the
// costs one below and one above it.
//
// The candidates of a clock meet in a tree, a register after each level; the best of the groups before is
// kept beside it. A candidate is one whose partner lies inside of the right image. At an end of the
// candidates the cost of the one neighbour that there is stands for both; beside an only candidate, its own.
`default_nettype none

module stereo_winner #(
    parameter PARALLEL = 64,
    parameter COLUMN_BITS = 11,
    parameter GROUP_BITS = 1,
    parameter LEVELS = 6
) (
    input wire clk,
    input wire reset,
    input wire go,
    input wire [7:0] disparities,
    // A byte for each candidate of the group, of the pixel in that column.
    input wire [8*PARALLEL-1:0] sums,
    input wire valid,
    input wire [COLUMN_BITS-1:0] column,
    input wire [GROUP_BITS-1:0] group,
    input wire first_group,
    input wire last_group,
    // LEVELS + 3 clocks after the pixel's last group.
    output reg [7:0] best,
    output reg [7:0] cost,
    output reg [7:0] below,
    output reg [7:0] above
);
    localparam LEAVES = 1 << LEVELS;
    // A node: no candidate, cost, disparity, the cost below and the one above.
    localparam NODE = 33;

    // A clock later `sums` are the next group, whose first candidate is above the last one here.
    reg [8*PARALLEL-1:0] here;
    reg [7:0] before_first;
    reg [COLUMN_BITS-1:0] column_0;
    reg [GROUP_BITS-1:0] group_0;
    always @(posedge clk) begin
        if (go) begin
            here <= sums;
            before_first <= here[8*PARALLEL-1 -: 8];
            column_0 <= column;
            group_0 <= group;
        end
    end

    wire [8*PARALLEL+15:0] around = {sums[7:0], here, before_first};
    wire [NODE*LEAVES-1:0] leaves;
    genvar i;
    generate
        for (i = 0; i < LEAVES; i = i + 1) begin : leaf
            if (i < PARALLEL) begin : candidate
                wire [7:0] disparity = group_0 * PARALLEL[7:0] + i[7:0];
                wire is_none = disparity >= disparities || {{(COLUMN_BITS-8){1'b0}}, disparity} > column_0;
                assign leaves[NODE*i +: NODE] = {
                    is_none, around[8*(i+1) +: 8], disparity, around[8*i +: 8], around[8*(i+2) +: 8]
                };
            end else begin : nothing
                assign leaves[NODE*i +: NODE] = {1'b1, {(NODE-1){1'b0}}};
            end
        end
    endgenerate

    // Level 0 are the leaves; the nodes of a level follow those of the level before.
    reg [NODE*(2*LEAVES-1)-1:0] nodes;
    genvar level;
    generate
        for (i = 0; i < LEAVES; i = i + 1) begin : base
            always @(posedge clk) if (go) nodes[NODE*i +: NODE] <= leaves[NODE*i +: NODE];
        end
        for (level = 1; level <= LEVELS; level = level + 1) begin : tree
            localparam FROM = 2 * LEAVES - 2 * (LEAVES >> (level - 1));
            localparam TO = 2 * LEAVES - 2 * (LEAVES >> level);
            for (i = 0; i < (LEAVES >> level); i = i + 1) begin : node
                wire [NODE-1:0] low = nodes[NODE*(FROM+2*i) +: NODE];
                wire [NODE-1:0] high = nodes[NODE*(FROM+2*i+1) +: NODE];
                wire takes_high = high[NODE-1 -: 9] < low[NODE-1 -: 9];
                always @(posedge clk) if (go) nodes[NODE*(TO+i) +: NODE] <= takes_high ? high : low;
            end
        end
    endgenerate

    // The token as far as the tree's root.
    reg [LEVELS+1:0] firsts;
    reg [LEVELS+1:0] lasts;
    reg [COLUMN_BITS*(LEVELS+2)-1:0] columns;
    always @(posedge clk) begin
        if (reset) begin
            firsts <= 0;
            lasts <= 0;
        end else if (go) begin
            firsts <= {firsts[LEVELS:0], valid && first_group};
            lasts <= {lasts[LEVELS:0], valid && last_group};
        end
        if (go) columns <= {columns[COLUMN_BITS*(LEVELS+1)-1:0], column};
    end

    wire [NODE-1:0] root = nodes[NODE*(2*LEAVES-2) +: NODE];
    reg [NODE-1:0] leader;
    wire [NODE-1:0] leads = firsts[LEVELS+1] || root[NODE-1 -: 9] < leader[NODE-1 -: 9] ? root : leader;
    wire [COLUMN_BITS-1:0] at = columns[COLUMN_BITS*(LEVELS+2)-1 -: COLUMN_BITS];
    // The largest candidate.
    wire [7:0] most = disparities - 8'd1;
    wire [7:0] largest = at < {{(COLUMN_BITS-8){1'b0}}, most} ? at[7:0] : most;
    wire has_below = leads[23:16] != 0;
    wire has_above = leads[23:16] != largest;

    always @(posedge clk) begin
        if (go) begin
            leader <= leads;
            if (lasts[LEVELS+1]) begin
                best <= leads[23:16];
                cost <= leads[31:24];
                below <= has_below ? leads[15:8] : has_above ? leads[7:0] : leads[31:24];
                above <= has_above ? leads[7:0] : has_below ? leads[15:8] : leads[31:24];
            end
        end
    end
endmodule

`default_nettype wire
