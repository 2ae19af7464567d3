// Decides for each frame whether it runs, what its reply says, and when the engine listens again. It keeps the number
// executed last and the epoch of the connection.
`default_nettype none
module frame_session (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic restart_i,  // event: a new connection
    // from the receiver
    input wire logic frame_i,  // event: a frame with a good CRC
    input wire logic [1:0] kind_i,
    input wire logic malformed_i,
    input wire logic [15:0] number_i,
    input wire logic epoch_good_i,
    // from executor and sender, events
    input wire logic executed_i,
    input wire logic sent_i,
    output logic listen_o,
    output logic start_o,  // event: the executor begins
    output logic execute_o,  // with start_o: the request runs
    output logic new_o,  // no request has run in this epoch yet
    output logic send_o,  // event: the reply begins
    output logic sending_o,
    // fields of the reply
    output logic [15:0] epoch_o,
    output logic [15:0] last_o,
    output logic [2:0] result_o,
    output logic repeats_o  // the reply has the results of executing last_o
);
  localparam logic [1:0] ASK = 2'd0;
  localparam logic [1:0] CONNECT = 2'd1;

  localparam logic [2:0] DONE = 3'd0;
  localparam logic [2:0] WRONG_NUMBER = 3'd2;
  localparam logic [2:0] WRONG_EPOCH = 3'd3;
  localparam logic [2:0] MALFORMED = 3'd4;

  logic        busy_q;
  logic        dropped_q;  // the reply belongs to an earlier connection
  logic        asks;
  logic        connects;
  logic        runs;  // the request is executed now, or was executed last
  logic        good;
  logic [15:0] ahead;

  assign ahead     = number_i - last_o;
  assign asks      = kind_i == ASK;
  assign connects  = !malformed_i && kind_i == CONNECT && epoch_good_i;
  assign runs      = !malformed_i && kind_i[1] && epoch_good_i && ahead[15:1] == 15'd0;

  assign good      = asks || connects || runs;

  assign listen_o  = !busy_q;
  assign start_o   = frame_i && !restart_i;
  assign execute_o = runs && ahead[0];
  assign send_o    = executed_i && !dropped_q && !restart_i;

  always_ff @(posedge clk_i) begin
    if ((executed_i && !send_o) || sent_i || (restart_i && sending_o)) busy_q <= 1'b0;
    if (sent_i || restart_i) sending_o <= 1'b0;
    dropped_q <= busy_q && (dropped_q || restart_i);
    if (send_o) sending_o <= 1'b1;
    if (start_o) begin
      busy_q <= 1'b1;
      repeats_o <= runs;
      result_o <= malformed_i ? MALFORMED : good ? DONE : !epoch_good_i ? WRONG_EPOCH : WRONG_NUMBER;
    end
    if (start_o && execute_o) last_o <= number_i;
    if (restart_i || (start_o && connects)) begin
      epoch_o <= epoch_o + 16'd1;
      new_o   <= 1'b1;
    end else if (start_o && execute_o) new_o <= 1'b0;
    if (rst_i) begin
      busy_q <= 1'b0;
      sending_o <= 1'b0;
      epoch_o <= 16'd0;
      new_o <= 1'b0;
      last_o <= 16'd0;
    end
  end
endmodule
`default_nettype wire
