// Second best: the least cost of the candidates over two px from the winner, 255 where there is none.
//
// The sums of a pixel's groups wait until its winner is known, and then go through a tree of their own, a
// register after each level. The second best comes WAIT - 1 clocks after the winner.
`default_nettype none

module stereo_second #(
    parameter PARALLEL = 64,
    parameter COLUMN_BITS = 11,
    parameter GROUP_BITS = 1,
    parameter LEVELS = 6,
    parameter WAIT = 8
) (
    input wire clk,
    input wire reset,
    input wire go,
    input wire [7:0] disparities,
    // The token of the sums, with a byte for each candidate of the group.
    input wire [8*PARALLEL-1:0] sums,
    input wire [COLUMN_BITS-1:0] column,
    input wire [GROUP_BITS-1:0] group,
    input wire first_group,
    input wire last_group,
    // The winner of the pixel whose sums have waited.
    input wire [7:0] best,
    output reg [7:0] second
);
    localparam LEAVES = 1 << LEVELS;

    wire [8*PARALLEL-1:0] here;
    wire [COLUMN_BITS-1:0] column_0;
    wire [GROUP_BITS-1:0] group_0;
    wire first_0, last_0;
    stereo_delay #(.BITS(8 * PARALLEL + COLUMN_BITS + GROUP_BITS + 2), .CLOCKS(WAIT)) delay (
        .clk(clk), .reset(reset), .go(go), .data({sums, column, group, first_group, last_group}),
        .delayed({here, column_0, group_0, first_0, last_0})
    );

    wire [8*LEAVES-1:0] leaves;
    genvar i;
    generate
        for (i = 0; i < LEAVES; i = i + 1) begin : leaf
            if (i < PARALLEL) begin : candidate
                wire [7:0] disparity = group_0 * PARALLEL[7:0] + i[7:0];
                wire is_none = disparity >= disparities || {{(COLUMN_BITS-8){1'b0}}, disparity} > column_0;
                wire is_near = disparity <= best + 8'd2 && best <= disparity + 8'd2;
                assign leaves[8*i +: 8] = is_none || is_near ? 8'hff : here[8*i +: 8];
            end else begin : nothing
                assign leaves[8*i +: 8] = 8'hff;
            end
        end
    endgenerate

    // Level 0 are the leaves; the nodes of a level follow those of the level before.
    reg [8*(2*LEAVES-1)-1:0] nodes;
    genvar level;
    generate
        for (i = 0; i < LEAVES; i = i + 1) begin : base
            always @(posedge clk) if (go) nodes[8*i +: 8] <= leaves[8*i +: 8];
        end
        for (level = 1; level <= LEVELS; level = level + 1) begin : tree
            localparam FROM = 2 * LEAVES - 2 * (LEAVES >> (level - 1));
            localparam TO = 2 * LEAVES - 2 * (LEAVES >> level);
            for (i = 0; i < (LEAVES >> level); i = i + 1) begin : node
                wire [7:0] low = nodes[8*(FROM+2*i) +: 8];
                wire [7:0] high = nodes[8*(FROM+2*i+1) +: 8];
                always @(posedge clk) if (go) nodes[8*(TO+i) +: 8] <= high < low ? high : low;
            end
        end
    endgenerate

    // The token as far as the tree's root.
    reg [LEVELS+1:1] firsts;
    reg [LEVELS+1:1] lasts;
    wire [LEVELS+1:0] all_firsts = {firsts, first_0};
    wire [LEVELS+1:0] all_lasts = {lasts, last_0};
    wire is_first = all_firsts[LEVELS+1];
    wire is_last = all_lasts[LEVELS+1];
    wire [7:0] root = nodes[8*(2*LEAVES-2) +: 8];
    reg [7:0] least;
    wire [7:0] least_now = is_first || root < least ? root : least;

    always @(posedge clk) begin
        if (go) begin
            firsts <= all_firsts[LEVELS:0];
            lasts <= all_lasts[LEVELS:0];
            least <= least_now;
            if (is_last) second <= least_now;
        end
    end
endmodule

`default_nettype wire
