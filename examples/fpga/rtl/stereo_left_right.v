// Left-right check: what each column of the right image keeps, and records of the winners with it.
//
// A right column keeps the cheapest of the left pixels that chose it, the first among equals. What column
// x - d keeps is settled once the last pixel that may choose it has, as many columns further as there are
// disparities, less one. So a pixel waits for that many more pixels, in a ring, and is then put together with
// what its partner keeps. The ring goes on from row to row.
`default_nettype none

module stereo_left_right #(
    parameter DISPARITIES = 64
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
    // A record: first and last of a frame and of a row, and its eight bytes.
    output reg record_valid,
    output reg [65:0] record
);
    localparam BITS = $clog2(2 * DISPARITIES);
    localparam SLOTS = 1 << BITS;

    reg [BITS-1:0] slot;
    reg [SLOTS-1:0] taken;
    reg [DISPARITIES-1:0] pixels;
    // What each slot's right column keeps.
    reg [7:0] kept_costs [0:SLOTS-1];
    reg [7:0] kept_disparities [0:SLOTS-1];

    wire [BITS-1:0] chosen = slot - best[BITS-1:0];
    // The pixel's own slot is a new column, which nobody has chosen yet.
    wire is_free = best == 0 || !taken[chosen];
    wire chooses = is_pixel && has_winner;
    wire keeps = valid && chooses && (is_free || cost < kept_costs[chosen]);

    always @(posedge clk) begin
        if (go && keeps) begin
            kept_costs[chosen] <= cost;
            kept_disparities[chosen] <= best;
        end
        if (reset || begins) begin
            slot <= 0;
            pixels <= 0;
        end else if (go && valid) begin
            slot <= slot + 1'b1;
            pixels <= {pixels[DISPARITIES-2:0], is_pixel};
            taken[slot] <= 1'b0;
            if (chooses) taken[chosen] <= 1'b1;
        end
    end

    // The pixels that wait.
    wire [49:0] waited;
    wire [BITS-1:0] due = slot - disparities;
    wire [BITS-2:0] last_waiting = disparities[BITS-2:0] - 1'b1;
    wire is_due = pixels[last_waiting];
    stereo_ram #(.BITS(50), .DEPTH(SLOTS)) waiting (
        .clk(clk),
        .read(go && valid),
        .read_address(due),
        .read_data(waited),
        .write(go && valid),
        .write_address(slot),
        .write_data({is_first, is_last, row, second, best, above, cost, below})
    );

    reg told;
    reg [BITS-1:0] told_slot;
    wire [BITS-1:0] partner = told_slot - waited[24 +: BITS];
    wire [7:0] kept = kept_disparities[partner];
    wire [55:0] bytes = {waited[47:40], waited[39:32], kept, waited[31:0]};
    wire [7:0] check = ~(bytes[55:48] ^ bytes[47:40] ^ bytes[39:32] ^ bytes[31:24]
        ^ bytes[23:16] ^ bytes[15:8] ^ bytes[7:0]);

    always @(posedge clk) begin
        if (reset) begin
            told <= 1'b0;
            record_valid <= 1'b0;
        end else if (go) begin
            told <= valid && is_due;
            record_valid <= told;
        end
        if (go) begin
            told_slot <= due;
            record <= {waited[49:48], check, bytes};
        end
    end
endmodule

`default_nettype wire
