// Data some clocks later, in a ring of block RAM. Clocks in which `go` is low do not count.
`default_nettype none

module stereo_delay #(
    parameter BITS = 8,
    // At least 3.
    parameter CLOCKS = 8
) (
    input wire clk,
    input wire reset,
    input wire go,
    input wire [BITS-1:0] data,
    output wire [BITS-1:0] delayed
);
    // Reading takes one of the clocks.
    localparam PLACES = CLOCKS - 1;
    localparam PLACE_BITS = $clog2(PLACES);
    localparam [PLACE_BITS-1:0] ONE = 1;
    localparam [PLACE_BITS-1:0] LAST = PLACES[PLACE_BITS-1:0] - ONE;

    reg [PLACE_BITS-1:0] place;
    stereo_ram #(.BITS(BITS), .DEPTH(PLACES)) ring (
        .clk(clk), .read(go), .read_address(place), .read_data(delayed),
        .write(go), .write_address(place), .write_data(data)
    );

    always @(posedge clk) begin
        if (reset) place <= 0;
        else if (go) place <= place == LAST ? {PLACE_BITS{1'b0}} : place + ONE;
    end
endmodule

`default_nettype wire
