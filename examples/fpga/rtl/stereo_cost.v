// Costs of all candidates of a pixel, from what it and its partners look like.
//
// In: a column's features. Out, two clocks later: for each candidate of the group
//
//   min(16, 2 max(0, X - greatest X', least X' - X) + |Y - Y'| + |B - B'| / 4 + ones(C xor C'))
`default_nettype none

module stereo_cost #(
    parameter DISPARITIES = 64,
    parameter PARALLEL = 64,
    parameter GROUPS = 1,
    parameter COLUMN_BITS = 11,
    parameter GROUP_BITS = 1
) (
    input wire clk,
    input wire go,
    input wire [7:0] least,
    input wire [COLUMN_BITS-1:0] read_column,
    // A column, once, with its features.
    input wire take,
    input wire [COLUMN_BITS-1:0] column,
    input wire [24:0] left,
    input wire [29:0] right,
    // The group, a clock later.
    // verilator lint_off UNUSEDSIGNAL
    // A single group has no number.
    input wire [GROUP_BITS-1:0] group,
    // verilator lint_on UNUSEDSIGNAL
    // Five bits for each candidate, another clock later.
    output reg [5*PARALLEL-1:0] costs
);
    reg [24:0] here;
    wire [30*DISPARITIES-1:0] partners;
    always @(posedge clk) if (go && take) here <= left;
    stereo_partners #(.BITS(30), .DISPARITIES(DISPARITIES), .COLUMN_BITS(COLUMN_BITS)) right_image (
        .clk(clk), .go(go), .least(least), .read_column(read_column), .take(take), .column(column),
        .value(right), .partners(partners)
    );

    // A group's partners, in 32 bits each: groups that begin at powers of two are chosen by few gates.
    // verilator lint_off UNUSEDSIGNAL
    wire [32*DISPARITIES-1:0] words;
    wire [32*PARALLEL-1:0] there;
    // verilator lint_on UNUSEDSIGNAL
    genvar i;
    generate
        for (i = 0; i < DISPARITIES; i = i + 1) begin : word
            assign words[32*i +: 32] = {2'd0, partners[30*i +: 30]};
        end
        if (GROUPS == 1) begin : one_group
            assign there = words;
        end else begin : groups
            assign there = words[group * 32 * PARALLEL +: 32 * PARALLEL];
        end
    endgenerate

    function [3:0] ones;
        input [7:0] bits;
        ones = {3'b0, bits[0]} + {3'b0, bits[1]} + {3'b0, bits[2]} + {3'b0, bits[3]}
            + {3'b0, bits[4]} + {3'b0, bits[5]} + {3'b0, bits[6]} + {3'b0, bits[7]};
    endfunction

    generate
        for (i = 0; i < PARALLEL; i = i + 1) begin : lane
            wire [4:0] least_x = there[32*i +: 5];
            wire [4:0] greatest_x = there[32*i+5 +: 5];
            wire [4:0] y = there[32*i+10 +: 5];
            wire [6:0] bright = there[32*i+15 +: 7];
            wire [4:0] along = here[4:0] > greatest_x ? here[4:0] - greatest_x
                : here[4:0] < least_x ? least_x - here[4:0] : 5'd0;
            wire [4:0] across = here[9:5] > y ? here[9:5] - y : y - here[9:5];
            // verilator lint_off UNUSEDSIGNAL
            // A quarter is counted.
            wire [6:0] apart = here[16:10] > bright ? here[16:10] - bright : bright - here[16:10];
            // verilator lint_on UNUSEDSIGNAL
            wire [6:0] apart_in_all = {1'b0, along, 1'b0} + {2'b0, across} + {2'b0, apart[6:2]}
                + {3'b0, ones(here[24:17] ^ there[32*i+22 +: 8])};
            always @(posedge clk) if (go) costs[5*i +: 5] <= apart_in_all > 16 ? 5'd16 : apart_in_all[4:0];
        end
    endgenerate
endmodule

`default_nettype wire
