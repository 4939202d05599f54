// Memory with one port to read and one to write, both clocked: block RAM in every family.
//
// A read of the address that is written in the same clock gives what stood there before.
`default_nettype none

module stereo_ram #(
    parameter BITS = 8,
    parameter DEPTH = 16
) (
    input wire clk,
    input wire read,
    input wire [$clog2(DEPTH)-1:0] read_address,
    output reg [BITS-1:0] read_data,
    input wire write,
    input wire [$clog2(DEPTH)-1:0] write_address,
    input wire [BITS-1:0] write_data
);
    reg [BITS-1:0] memory [0:DEPTH-1];

    always @(posedge clk) begin
        if (read) read_data <= memory[read_address];
        if (write) memory[write_address] <= write_data;
    end
endmodule

`default_nettype wire
