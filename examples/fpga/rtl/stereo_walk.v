// The walk of a frame: which column of which line is worked on in each clock, and the stream of pixels.
//
// A frame takes height + 2 + RADIUS_Y line steps: in step t line t comes in, the census of row t - 2 is
// made, and row t - 2 - RADIUS_Y gets its winners. A step takes width + 7 columns: in column c the census of
// column c - 3 and the winner of column c - 7. A column takes GROUPS clocks, each for PARALLEL disparities.
// After the last step as many columns follow as there are disparities, which carry nothing and bring the last
// winners out of the left-right check, and DEPTH more, until all stages are done with the frame.
//
// The token goes with the column through all stages. A clock in which `go` is low changes nothing anywhere.
`default_nettype none

module stereo_walk #(
    parameter [31:0] WIDTH = 640,
    parameter [31:0] DEPTH = 40,
    parameter GROUPS = 1,
    parameter RADIUS_Y = 4,
    // A step takes SWEEPS * width + BEHIND + 1 columns.
    parameter SWEEPS = 1,
    parameter [31:0] BEHIND = 6,
    parameter COLUMN_BITS = 11,
    parameter GROUP_BITS = 1,
    parameter ADDRESS_BITS = 10,
    parameter CODE_BITS = 13
) (
    input wire clk,
    input wire reset,
    input wire go,
    // What the registers say.
    input wire enable,
    input wire [COLUMN_BITS-1:0] set_width,
    input wire [15:0] set_height,
    input wire [7:0] set_disparities,
    input wire [1:0] set_noise,
    input wire [7:0] set_least,
    // Pixels: left in the low byte, right in the high one; `user` begins a frame, `last` ends a line.
    input wire [15:0] pixel_data,
    input wire pixel_valid,
    input wire pixel_user,
    input wire pixel_last,
    output wire pixel_ready,
    // What the frame that is under way was begun with.
    output reg [COLUMN_BITS-1:0] width,
    output reg [7:0] disparities,
    output reg [1:0] noise,
    output reg [7:0] least,
    output reg running,
    // One clock each: a frame begins, all that is under way is to be forgotten, and why.
    output wire begins,
    output wire aborts,
    output wire too_short,
    output wire too_long,
    output wire cut_off,
    // Where lines are read, and the token a clock later.
    output wire [ADDRESS_BITS-1:0] next_column,
    output reg valid,
    output reg [15:0] pixels,
    output reg [COLUMN_BITS-1:0] column,
    output reg [GROUP_BITS-1:0] group,
    output reg first_group,
    output reg last_group,
    output reg inside_width,
    output reg inside_height,
    output reg first_line,
    output reg first_code,
    output reg enters,
    output reg leaves,
    output reg [CODE_BITS-1:0] code_row,
    output reg has_winners,
    // Whether they are the frame's last.
    output reg has_last,
    output reg [15:0] row,
    output reg drains
);
    localparam [15:0] WINDOW = 2 * RADIUS_Y + 1;
    localparam [15:0] BELOW = 2 + RADIUS_Y;
    localparam [GROUP_BITS-1:0] LAST_GROUP = GROUPS[GROUP_BITS-1:0] - 1'b1;
    localparam LAST_ROW = 2 * RADIUS_Y * WIDTH;
    localparam [CODE_BITS-1:0] LAST_CODE_ROW = LAST_ROW[CODE_BITS-1:0];
    localparam [CODE_BITS-1:0] CODE_ROW = WIDTH[CODE_BITS-1:0];

    // Columns behind a frame's last winner, and behind a line's last column.
    localparam [COLUMN_BITS-1:0] DRAIN = DEPTH[COLUMN_BITS-1:0];
    localparam [COLUMN_BITS-1:0] MORE = BEHIND[COLUMN_BITS-1:0];

    reg [15:0] height;
    // The step, the column and the group that are due; the place of the step's codes.
    reg [16:0] step;
    reg [COLUMN_BITS-1:0] at;
    reg [GROUP_BITS-1:0] at_group;
    reg [CODE_BITS-1:0] at_code_row;
    reg draining;

    wire in_width = at < width;
    wire in_height = step < {1'b0, height};
    wire is_first_group = at_group == 0;
    wire is_last_group = at_group == LAST_GROUP;
    wire takes = running && !draining && in_width && in_height && is_first_group;
    wire at_start = step == 0 && at == 0;
    wire [COLUMN_BITS-1:0] last_inside = width - 1'b1;
    wire [COLUMN_BITS-1:0] last_column = (SWEEPS == 1 ? width : width << 1) + MORE;
    wire [COLUMN_BITS-1:0] last_drained = {{(COLUMN_BITS-8){1'b0}}, disparities} + DRAIN;
    wire is_last_column = draining ? at == last_drained : at == last_column;

    wire is_last_row = at_code_row == LAST_CODE_ROW;

    // A pixel that begins a frame waits until the frame before is given up or done.
    assign begins = !running && enable && pixel_valid && pixel_user;
    assign cut_off = takes && pixel_valid && pixel_user && !at_start;
    assign pixel_ready = running ? takes && go && !cut_off : !begins;
    wire taken = takes && go && pixel_valid && !cut_off;
    assign too_short = taken && pixel_last && at != last_inside;
    assign too_long = taken && !pixel_last && at == last_inside;
    assign aborts = cut_off || too_short || too_long;

    wire moves = running && go && (takes ? taken : 1'b1);
    assign next_column = at[ADDRESS_BITS-1:0];

    always @(posedge clk) begin
        if (reset || aborts) begin
            running <= 1'b0;
        end else if (begins) begin
            running <= 1'b1;
        end else if (moves && draining && is_last_column) begin
            running <= 1'b0;
        end

        if (begins) begin
            width <= set_width;
            height <= set_height;
            disparities <= set_disparities;
            noise <= set_noise;
            least <= set_least;
            step <= 0;
            at <= 0;
            at_group <= 0;
            at_code_row <= 0;
            draining <= 1'b0;
        end else if (moves) begin
            if (!is_last_group && !draining) begin
                at_group <= at_group + 1'b1;
            end else begin
                at_group <= 0;
                at <= is_last_column ? {COLUMN_BITS{1'b0}} : at + 1'b1;
                if (is_last_column) begin
                    step <= step + 1'b1;
                    if (step >= 2) at_code_row <= is_last_row ? {CODE_BITS{1'b0}} : at_code_row + CODE_ROW;
                    draining <= step == {1'b0, height} + {1'b0, BELOW} - 17'd1;
                end
            end
        end

        if (reset || aborts) begin
            valid <= 1'b0;
        end else if (go) begin
            valid <= moves;
        end
        if (go) begin
            pixels <= pixel_data;
            column <= at;
            group <= at_group;
            first_group <= is_first_group;
            last_group <= is_last_group || draining;
            inside_width <= in_width;
            inside_height <= in_height;
            first_line <= step == 0;
            first_code <= step == 2;
            enters <= step >= 2 && step < {1'b0, height} + 17'd2;
            leaves <= step >= {1'b0, WINDOW} + 17'd2;
            code_row <= at_code_row;
            has_winners <= step >= {1'b0, BELOW} && !draining;
            has_last <= step == {1'b0, height} + {1'b0, BELOW} - 17'd1;
            row <= step[15:0] - BELOW;
            drains <= draining;
        end
    end

endmodule

`default_nettype wire
