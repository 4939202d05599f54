// Left-right check: what each column of the right image keeps, and records of the winners with it.
//
// A right column keeps the cheapest of the left pixels that chose it, the first among equals. What column
// x - d keeps is settled once the last pixel that may choose it has, as many columns further as there are
// disparities, less one. So a pixel waits for that many more pixels, in a ring, and is then put together with
// what its partner keeps. The ring goes on from row to row.
`default_nettype none

module stereo_left_right #(
    parameter DISPARITIES = 64,
    // Whether the pixels of an offer may be compared.
    parameter COMPARES = 0
) (
    input wire clk,
    input wire reset,
    input wire go,
    // A frame begins; all pixels of the one before are out.
    input wire begins,
    input wire [$clog2(2*DISPARITIES)-1:0] disparities,
    // A pixel, or one that only moves the ring on.
    input wire valid,
    input wire is_pixel,
    // Whether the pixel has a candidate, and so a partner.
    input wire has_winner,
    input wire is_first,
    input wire is_last,
    input wire [7:0] row,
    input wire [7:0] best,
    input wire [7:0] cost,
    input wire [7:0] below,
    input wire [7:0] above,
    input wire [7:0] second,
    // Whether an offer also costs four times what its pixels differ by, at most 255 in all; the smallest
    // disparity, and the column's left pixel and right one.
    // verilator lint_off UNUSEDSIGNAL
    input wire compares,
    input wire [7:0] least,
    input wire [7:0] left,
    input wire [7:0] right,
    // verilator lint_on UNUSEDSIGNAL
    // A record: first and last of a frame and of a row, and its eight bytes.
    output reg record_valid,
    output reg [65:0] record
);
    localparam BITS = $clog2(2 * DISPARITIES);
    localparam SLOTS = 1 << BITS;

    // A pixel and what it offers: its cost, as it comes, or a clock later its cost with what the pixels add.
    wire comes, comes_pixel, comes_winner;
    wire [49:0] coming;
    wire [7:0] offered;
    generate
        if (COMPARES == 0) begin : by_cost
            assign comes = valid;
            assign comes_pixel = is_pixel;
            assign comes_winner = is_pixel && has_winner;
            assign coming = {is_first, is_last, row, second, best, above, cost, below};
            assign offered = cost;
        end else begin : by_pixels
            // The right pixels, each where the column looks for it whose smallest disparity leads there.
            reg [7:0] rights [0:511];
            reg [8:0] place, own_place;
            reg [7:0] own_left;
            reg has_pixels, came, came_pixel, came_winner;
            reg [49:0] came_with;
            always @(posedge clk) begin
                if (reset || begins) begin
                    place <= 0;
                    came <= 1'b0;
                end else if (go) begin
                    if (valid) place <= place + 1'b1;
                    came <= valid;
                end
                if (go && valid) rights[place + {1'b0, least}] <= right;
                if (go) begin
                    own_place <= place;
                    own_left <= left;
                    has_pixels <= compares;
                    came_pixel <= is_pixel;
                    came_winner <= is_pixel && has_winner;
                    came_with <= {is_first, is_last, row, second, best, above, cost, below};
                end
            end
            wire [7:0] of_partner = rights[own_place - {1'b0, came_with[31:24]}];
            wire [7:0] apart = own_left > of_partner ? own_left - of_partner : of_partner - own_left;
            wire [10:0] dear = {3'b0, came_with[15:8]} + {1'b0, apart, 2'b0};
            assign comes = came;
            assign comes_pixel = came_pixel;
            assign comes_winner = came_winner;
            assign coming = came_with;
            assign offered = !has_pixels ? came_with[15:8] : dear[10:8] != 0 ? 8'hff : dear[7:0];
        end
    endgenerate

    // The pixel a clock later, its place in the ring, that of the right column that it chose, and its offer.
    reg [BITS-1:0] slot;
    reg [BITS-1:0] here;
    reg [BITS-1:0] chosen;
    reg moves, holds_pixel, chooses, chooses_own;
    reg [49:0] pixel;
    reg [7:0] offer;
    always @(posedge clk) begin
        if (reset || begins) begin
            slot <= 0;
            moves <= 1'b0;
        end else if (go) begin
            if (comes) slot <= slot + 1'b1;
            moves <= comes;
        end
        if (go) begin
            here <= slot;
            chosen <= slot - coming[24 +: BITS];
            chooses_own <= coming[31:24] == 0;
            holds_pixel <= comes_pixel;
            chooses <= comes_winner;
            pixel <= coming;
            offer <= offered;
        end
    end

    // What each slot's right column keeps.
    reg [SLOTS-1:0] taken;
    reg [7:0] kept_costs [0:SLOTS-1];
    reg [7:0] kept_disparities [0:SLOTS-1];
    // The pixel's own slot is a new column, which nobody has chosen yet.
    wire is_free = chooses_own || !taken[chosen];
    wire keeps = moves && chooses && (is_free || offer < kept_costs[chosen]);

    reg [DISPARITIES-1:0] pixels;
    always @(posedge clk) begin
        if (go && keeps) begin
            kept_costs[chosen] <= offer;
            kept_disparities[chosen] <= pixel[31:24];
        end
        if (reset || begins) begin
            pixels <= 0;
        end else if (go && moves) begin
            pixels <= {pixels[DISPARITIES-2:0], holds_pixel};
            taken[here] <= 1'b0;
            if (chooses) taken[chosen] <= 1'b1;
        end
    end

    // The pixels that wait: the one that is due with this pixel was read with the one before.
    wire [49:0] waited;
    wire [BITS-1:0] due = here - disparities;
    wire [BITS-2:0] last_waiting = disparities[BITS-2:0] - 1'b1;
    stereo_ram #(.BITS(50), .DEPTH(SLOTS)) waiting (
        .clk(clk),
        .read(go && moves),
        .read_address(due + 1'b1),
        .read_data(waited),
        .write(go && moves),
        .write_address(here),
        .write_data(pixel)
    );

    // The pixel that is due, what its partner keeps, and the record of both.
    reg told, kept_told;
    reg [49:0] told_pixel, kept_pixel;
    reg [BITS-1:0] told_slot;
    wire [BITS-1:0] partner = told_slot - told_pixel[24 +: BITS];
    reg [7:0] kept;
    wire [55:0] bytes = {kept_pixel[47:40], kept_pixel[39:32], kept, kept_pixel[31:0]};
    wire [7:0] check = ~(bytes[55:48] ^ bytes[47:40] ^ bytes[39:32] ^ bytes[31:24]
        ^ bytes[23:16] ^ bytes[15:8] ^ bytes[7:0]);

    always @(posedge clk) begin
        if (reset) begin
            told <= 1'b0;
            kept_told <= 1'b0;
            record_valid <= 1'b0;
        end else if (go) begin
            told <= moves && pixels[last_waiting];
            kept_told <= told;
            record_valid <= kept_told;
        end
        if (go) begin
            told_slot <= due;
            told_pixel <= waited;
            kept_pixel <= told_pixel;
            kept <= kept_disparities[partner];
            record <= {kept_pixel[49:48], check, bytes};
        end
    end
endmodule

`default_nettype wire
