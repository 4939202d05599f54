// From sums to records: each pixel's winner with the costs beside it, the second best if it is sought,
// what the winner's partner keeps, and the queue of records on their way out.
//
//   stereo_winner      the cheapest candidate, with the costs beside it
//   stereo_second      the cheapest candidate that is not beside it
//   stereo_left_right  what the winner's partner keeps
//   stereo_fifo        records on their way out
//
// `go` is low when the queue fills up: then nothing moves in any stage.
`default_nettype none

module stereo_search #(
    parameter DISPARITIES = 64,
    parameter PARALLEL = 64,
    parameter SECOND_BEST = 0,
    parameter COLUMN_BITS = 11,
    parameter GROUP_BITS = 1,
    parameter LEVELS = 6,
    // Clocks that what is said of a pixel comes before its sums.
    parameter AHEAD = 8,
    // Clocks from a winner to its second best; 0 where none is sought.
    parameter LATER = 0,
    // Whether the pixels of an offer may be compared.
    parameter COMPARES = 0
) (
    input wire clk,
    // All that is under way is to be forgotten.
    input wire forgets,
    input wire begins,
    input wire [7:0] disparities,
    // The smallest disparity.
    input wire [7:0] least,
    // The token of the sums, with a byte for each candidate of the group.
    input wire [8*PARALLEL-1:0] sums,
    input wire valid,
    input wire [COLUMN_BITS-1:0] column,
    input wire [GROUP_BITS-1:0] group,
    input wire first_group,
    input wire last_group,
    // What is said of a column: whether the left-right check moves on by one, and whether that is a pixel.
    input wire moves,
    input wire is_pixel,
    input wire is_first,
    input wire is_last,
    input wire [7:0] row,
    // Whether what the left pixel and the right one differ by counts in the left-right check, and the pixels of
    // the column, five clocks later.
    input wire compares,
    input wire [15:0] pixels,
    // Records: first and last of a frame and of a row.
    output wire record_valid,
    input wire record_ready,
    output wire [63:0] record,
    output wire record_first,
    output wire record_last,
    output wire go
);
    localparam SLOT_BITS = $clog2(2 * DISPARITIES);
    localparam WINNER = AHEAD + LEVELS + 3;
    localparam SAID = 12;

    // The largest candidate that there is at the column; left of the smallest disparity there is none.
    wire [COLUMN_BITS-1:0] wide_least = {{(COLUMN_BITS-8){1'b0}}, least};
    wire is_reached = column >= wide_least;
    wire [COLUMN_BITS-1:0] reach = is_reached ? column - wide_least : {COLUMN_BITS{1'b0}};
    wire [7:0] best, cost, below, above;

    stereo_winner #(
        .PARALLEL(PARALLEL), .COLUMN_BITS(COLUMN_BITS), .GROUP_BITS(GROUP_BITS), .LEVELS(LEVELS)
    ) winner (
        .clk(clk), .reset(forgets), .go(go), .disparities(disparities), .sums(sums), .valid(valid),
        .column(reach), .group(group), .first_group(first_group), .last_group(last_group),
        .best(best), .cost(cost), .below(below), .above(above)
    );

    // What is said of the winner, beside it; whether it is one is known with the sums.
    reg [WINNER-1:0] steps;
    reg [SAID*WINNER-1:0] said;
    reg [LEVELS+2:0] reached;
    always @(posedge clk) begin
        if (forgets) steps <= 0;
        else if (go) steps <= {steps[WINNER-2:0], moves};
        if (go) begin
            said <= {said[SAID*(WINNER-1)-1:0], compares, is_pixel, is_first, is_last, row};
            reached <= {reached[LEVELS+1:0], is_reached};
        end
    end

    wire [15:0] seen;
    generate
        if (COMPARES == 0) begin : no_pixels
            assign seen = pixels;
        end else begin : with_pixels
            stereo_delay #(.BITS(16), .CLOCKS(WINNER - 5)) columns (
                .clk(clk), .reset(forgets), .go(go), .data(pixels), .delayed(seen)
            );
        end
    endgenerate

    localparam TELLER = SAID + 49;
    wire [TELLER-1:0] found = {
        seen, reached[LEVELS+2], said[SAID*WINNER-1 -: SAID], best, cost, below, above
    };
    wire told;
    wire [TELLER-1:0] teller;
    wire [7:0] second;
    generate
        if (SECOND_BEST == 0) begin : only_best
            assign told = steps[WINNER-1];
            assign teller = found;
            assign second = 8'hff;
        end else begin : second_best
            reg [LATER-1:0] finds;
            assign told = finds[LATER-1];
            always @(posedge clk) begin
                if (forgets) finds <= 0;
                else if (go) finds <= {finds[LATER-2:0], steps[WINNER-1]};
            end
            stereo_delay #(.BITS(TELLER), .CLOCKS(LATER)) later (
                .clk(clk), .reset(forgets), .go(go), .data(found), .delayed(teller)
            );
            stereo_second #(
                .PARALLEL(PARALLEL), .COLUMN_BITS(COLUMN_BITS), .GROUP_BITS(GROUP_BITS), .LEVELS(LEVELS),
                .WAIT(LATER + 1)
            ) others (
                .clk(clk), .reset(forgets), .go(go), .disparities(disparities), .sums(sums),
                .column(reach), .group(group), .first_group(valid && first_group),
                .last_group(valid && last_group), .best(best), .second(second)
            );
        end
    endgenerate

    wire made;
    wire [65:0] made_record;

    stereo_left_right #(.DISPARITIES(DISPARITIES), .COMPARES(COMPARES)) left_right (
        .clk(clk), .reset(forgets), .go(go), .begins(begins), .disparities(disparities[SLOT_BITS-1:0]),
        .valid(told), .compares(teller[43]), .least(least), .left(teller[60:53]), .right(teller[52:45]), .is_pixel(teller[42]),
        .has_winner(teller[44]), .is_first(teller[41]),
        .is_last(teller[40]), .row(teller[39:32]), .best(teller[31:24]), .cost(teller[23:16]),
        .below(teller[15:8]), .above(teller[7:0]), .second(second), .record_valid(made), .record(made_record)
    );

    stereo_fifo #(.BITS(66)) fifo (
        .clk(clk), .reset(forgets), .put(go && made), .put_data(made_record), .take_valid(record_valid),
        .take_data({record_first, record_last, record}), .take_ready(record_ready), .has_room(go)
    );
endmodule

`default_nettype wire
