// The right image's values beside a column: for each candidate that of its partner.
//
// Candidate d of column x is column x - least - d; where that lies left of the image, its first column stands
// in. The last values wait in a ring until the smallest disparity is reached.
`default_nettype none

module stereo_partners #(
    parameter BITS = 8,
    parameter DISPARITIES = 64,
    parameter COLUMN_BITS = 11
) (
    input wire clk,
    input wire go,
    input wire [7:0] least,
    // The column of the token of the clock before, or of this one where it has come already.
    // verilator lint_off UNUSEDSIGNAL
    // The ring has 256 places.
    input wire [COLUMN_BITS-1:0] read_column,
    // verilator lint_on UNUSEDSIGNAL
    // A column, once.
    input wire take,
    input wire [COLUMN_BITS-1:0] column,
    input wire [BITS-1:0] value,
    // A clock later, candidate 0 in the lowest bits.
    output reg [BITS*DISPARITIES-1:0] partners
);
    wire [BITS-1:0] waited;
    stereo_ram #(.BITS(BITS), .DEPTH(256)) ring (
        .clk(clk), .read(go), .read_address(read_column[7:0] - least), .read_data(waited),
        .write(go && take), .write_address(column[7:0]), .write_data(value)
    );

    reg [BITS-1:0] first;
    reg [BITS-1:0] latest;
    wire is_outside = column <= {{(COLUMN_BITS-8){1'b0}}, least};
    wire [BITS-1:0] next = least == 0 ? value : is_outside ? first : least == 1 ? latest : waited;
    always @(posedge clk) begin
        if (go && take) begin
            latest <= value;
            if (column == 0) first <= value;
            partners <= column == 0
                ? {DISPARITIES{value}}
                : {partners[BITS*(DISPARITIES-1)-1:0], next};
        end
    end
endmodule

`default_nettype wire
