// A register between two stages, or none: then what comes in goes out in the same clock.
`default_nettype none

module stereo_stage #(
    parameter BITS = 8,
    parameter HOLDS = 1
) (
    // verilator lint_off UNUSEDSIGNAL
    // Wires alone have no clock.
    input wire clk,
    input wire go,
    // verilator lint_on UNUSEDSIGNAL
    input wire [BITS-1:0] data,
    output wire [BITS-1:0] held
);
    generate
        if (HOLDS == 0) begin : wires
            assign held = data;
        end else begin : registers
            reg [BITS-1:0] stored;
            always @(posedge clk) if (go) stored <= data;
            assign held = stored;
        end
    endgenerate
endmodule

`default_nettype wire
