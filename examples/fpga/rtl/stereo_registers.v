// Registers on a Wishbone bus (classic cycles, 32 bits, one wait state). Offsets in bytes:
//
//   00 ID        r    0x53420001: "SB", version 1 of this map
//   04 CONTROL   rw   bit 0: enable, the next frame that begins is taken; set with bad values, it stays 0;
//                     bit 1: written as 1, what is under way is forgotten (reads 0)
//   08 STATUS    rw1c bit 0: a frame is under way (r); 1: a frame is done; 2: a line was too short; 3: a line
//                     was too long; 4: a frame was cut off by the next one; 5: a bad register value
//   0c SIZE      rw   15..0: pixels in a line, 16 to CAPACITY's; 31..16: lines, at least 1
//   10 SEARCH    rw   7..0: disparities, 16 to CAPACITY's and at most the pixels in a line;
//                     9..8: the noise that lines are smoothed against, 0 none, 1 low, 2 high;
//                     23..16: the smallest disparity
//   14 CAPACITY  r    15..0: pixels in a line; 23..16: disparities; 31..24: disparities in a clock
//   18 METHOD    r    7..0: 0 for fast, 1 for block, 2 for sgm; 15..8: rows that the window looks up and
//                     down; 16: whether the second best is sought
//   1c CLOCKS    r    clocks of the frame that is under way, or of the last one
//   20 ROWS      r    rows of this frame whose last record was taken
//
// SIZE and SEARCH are written while CONTROL is 0; otherwise bit 5 is set and nothing changes.
`default_nettype none

module stereo_registers #(
    parameter [31:0] WIDTH = 640,
    parameter [31:0] DISPARITIES = 64,
    parameter [31:0] PARALLEL = 64,
    parameter [31:0] METHOD = 1,
    parameter [31:0] SECOND_BEST = 0,
    parameter [31:0] RADIUS_Y = 4,
    parameter COLUMN_BITS = 11
) (
    input wire clk,
    input wire reset,
    input wire bus_cycle,
    input wire bus_strobe,
    input wire bus_write,
    input wire [5:2] bus_address,
    input wire [31:0] bus_data,
    output reg [31:0] bus_answer,
    output reg bus_ack,
    output reg enable,
    // One clock: what is under way is to be forgotten.
    output reg forget,
    output wire [COLUMN_BITS-1:0] set_width,
    output wire [15:0] set_height,
    output wire [7:0] set_disparities,
    output wire [1:0] set_noise,
    output wire [7:0] set_least,
    input wire running,
    input wire begins,
    input wire too_short,
    input wire too_long,
    input wire cut_off,
    input wire aborts,
    input wire row_taken
);
    localparam [15:0] MOST_WIDTH = WIDTH[15:0];
    localparam [7:0] MOST_DISPARITIES = DISPARITIES[7:0];
    localparam [7:0] IN_A_CLOCK = PARALLEL[7:0];
    localparam [7:0] IS_METHOD = METHOD[7:0];
    localparam [7:0] RADIUS = RADIUS_Y[7:0];

    reg [31:0] size;
    reg [23:0] search;
    reg [4:0] events;
    reg [31:0] clocks;
    reg [15:0] rows;
    reg ran;

    assign set_width = size[COLUMN_BITS-1:0];
    assign set_height = size[31:16];
    assign set_disparities = search[7:0];
    assign set_noise = search[9:8];
    assign set_least = search[23:16];

    wire is_good = size[15:0] >= 16 && size[15:0] <= MOST_WIDTH && size[31:16] != 0
        && search[7:0] >= 16 && search[7:0] <= MOST_DISPARITIES && {8'd0, search[7:0]} <= size[15:0];
    wire writes = bus_cycle && bus_strobe && bus_write && !bus_ack;
    wire [3:0] place = bus_address;
    wire sets_control = writes && place == 1;
    wire sets_search = writes && (place == 3 || place == 4);
    wire is_search = bus_data[31:24] == 0 && bus_data[15:10] == 0 && bus_data[9:8] != 3;
    wire is_bad = (sets_control && bus_data[0] && !is_good) || (sets_search && enable);
    wire [4:0] cleared = writes && place == 2 ? bus_data[5:1] : 5'd0;
    wire done = ran && !running;

    always @(posedge clk) begin
        bus_ack <= !reset && bus_cycle && bus_strobe && !bus_ack;
        if (reset) begin
            enable <= 1'b0;
            forget <= 1'b0;
            size <= 0;
            search <= 0;
            events <= 0;
            clocks <= 0;
            rows <= 0;
            ran <= 1'b0;
        end else begin
            if (sets_control) enable <= bus_data[0] && is_good;
            forget <= sets_control && bus_data[1];
            if (writes && place == 3 && !enable) size <= bus_data;
            // With other bits there is no such search.
            if (writes && place == 4 && !enable) search <= is_search ? bus_data[23:0] : 24'd0;
            events <= (events & ~cleared) | {is_bad, cut_off, too_long, too_short, done};
            ran <= running && !aborts && !forget;
            if (begins) clocks <= 0;
            else if (running) clocks <= clocks + 1;
            if (begins) rows <= 0;
            else if (row_taken) rows <= rows + 1;
        end
        case (place)
            4'd0: bus_answer <= 32'h53420001;
            4'd1: bus_answer <= {31'd0, enable};
            4'd2: bus_answer <= {26'd0, events, running || ran};
            4'd3: bus_answer <= size;
            4'd4: bus_answer <= {8'd0, search};
            4'd5: bus_answer <= {IN_A_CLOCK, MOST_DISPARITIES, MOST_WIDTH};
            4'd6: bus_answer <= {15'd0, SECOND_BEST != 0, RADIUS, IS_METHOD};
            4'd7: bus_answer <= clocks;
            4'd8: bus_answer <= {16'd0, rows};
            default: bus_answer <= 0;
        endcase
    end
endmodule

`default_nettype wire
