// Records on their way out: a queue that says early that it fills up, so that all stages stop on a register.
`default_nettype none

module stereo_fifo #(
    parameter BITS = 66,
    parameter DEPTH_BITS = 4
) (
    input wire clk,
    input wire reset,
    input wire put,
    input wire [BITS-1:0] put_data,
    output wire take_valid,
    output wire [BITS-1:0] take_data,
    input wire take_ready,
    // Low once half of the places are taken.
    output reg has_room
);
    reg [BITS-1:0] memory [0:(1<<DEPTH_BITS)-1];
    reg [DEPTH_BITS:0] written;
    reg [DEPTH_BITS:0] read;
    wire [DEPTH_BITS:0] waiting = written - read;

    assign take_valid = written != read;
    assign take_data = memory[read[DEPTH_BITS-1:0]];

    always @(posedge clk) begin
        if (put) memory[written[DEPTH_BITS-1:0]] <= put_data;
        if (reset) begin
            written <= 0;
            read <= 0;
            has_room <= 1'b0;
        end else begin
            if (put) written <= written + 1'b1;
            if (take_valid && take_ready) read <= read + 1'b1;
            has_room <= !waiting[DEPTH_BITS] && !waiting[DEPTH_BITS-1];
        end
    end
endmodule

`default_nettype wire
