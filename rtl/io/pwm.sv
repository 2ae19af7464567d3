// Pulse width modulation of outputs, on two channels. PWM commands set a channel's duty at their place on the path;
// instant_commands says when. An output of a channel has its level during a pulse, and the idle level between pulses.
//
// If a duty follows the speed, nothing is on at rest: a pulse under way ends there. Between consecutive paths, no path
// is under way for some clocks; these clocks do not count as rest.
`default_nettype none
module pwm #(
    parameter int Outputs = 4  // 1 to 16
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // commands
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input wire logic take_i,  // PWM is taken now; its last halfword is on load_i
    input wire logic apply_i,  // the PWM commands taken before take effect
    input wire logic drop_i,  // the PWM commands taken before are dropped
    // speed
    input wire logic [feed_pkg::WIDTH-1:0] feed_i,
    input wire logic runs_i,  // a path is under way
    // outputs
    input wire logic [Outputs-1:0] level_i,
    input wire logic [Outputs-1:0] idle_i,  // strap
    output logic [Outputs-1:0] pin_o  // combinational
);
  localparam int ORDER = pwm_order_pkg::WIDTH;
  // Clocks after the last one with a path until motion counts as over.
  localparam logic [6:0] GAP = 7'd127;

  logic [     2*27-1:0] periods_q;
  logic [2*Outputs-1:0] outputs_q;  // outputs of channel 1, outputs of channel 0
  logic [         31:0] data;
  logic [          1:0] sets;  // events, by channel: the period is set
  logic [          1:0] stop;

  assign data = setting_bus_pkg::data(setting_i);
  assign sets = {
    setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_PWM_PERIOD_1),
    setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_PWM_PERIOD_0)
  };
  assign stop = sets | {outputs_q[Outputs+:Outputs] == '0, outputs_q[0+:Outputs] == '0};

  always_ff @(posedge clk_i) begin
    if (sets[0]) periods_q[0+:27] <= data[26:0];
    if (sets[1]) periods_q[27+:27] <= data[26:0];
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_PWM_OUTPUTS))
      outputs_q <= {data[16+:Outputs], data[0+:Outputs]};
    if (rst_i) begin
      periods_q <= {card_map_pkg::RESET_PWM_PERIOD_1[26:0], card_map_pkg::RESET_PWM_PERIOD_0[26:0]};
      outputs_q <= '0;
    end
  end

  // Commands: one per channel can wait.
  logic [       47:0] words_q;
  logic               merge_q;
  logic [        1:0] waits_q;
  logic [2*ORDER-1:0] waiting_q;
  logic [2*ORDER-1:0] orders_q;

  always_ff @(posedge clk_i) begin
    words_q <= {load_bus_pkg::word(load_i), words_q[47:16]};
    merge_q <= take_i;
    if (apply_i) waits_q <= 2'b00;
    for (int n = 0; n < 2; n++) begin
      if (merge_q && words_q[0] == 1'(n)) begin
        waiting_q[n*ORDER+:ORDER] <= pwm_order_pkg::of_words(words_q);
        waits_q[n] <= 1'b1;
      end
      if (apply_i && waits_q[n]) orders_q[n*ORDER+:ORDER] <= waiting_q[n*ORDER+:ORDER];
    end
    if (drop_i || rst_i) {merge_q, waits_q} <= '0;
    if (rst_i) orders_q <= '0;
  end

  // Speed.
  logic [6:0] gap_q;  // clocks for which motion still counts
  logic moves;
  logic still;

  assign moves = gap_q != 7'd0 && !feed_i[feed_pkg::SILENT];
  assign still = !moves || feed_i[feed_pkg::AT_REST];

  always_ff @(posedge clk_i) begin
    if (runs_i && feed_i[feed_pkg::GIVES]) gap_q <= GAP;
    else if (gap_q != 7'd0) gap_q <= gap_q - 7'd1;
    if (feed_i[feed_pkg::SILENT] || rst_i) gap_q <= 7'd0;
  end

  logic [ 1:0] due;
  logic [ 1:0] done;
  logic [26:0] on;
  logic [ 1:0] pulse;
  logic [ 1:0] follows;

  assign follows = {orders_q[ORDER+pwm_order_pkg::FOLLOWS], orders_q[pwm_order_pkg::FOLLOWS]};

  pwm_duty on_times (
      .clk_i,
      .rst_i,
      .due_i(due),
      .cancel_i(stop | {2{apply_i && waits_q != 2'b00}}),
      .orders_i(orders_q),
      .periods_i(periods_q),
      .rate_i(moves ? feed_pkg::rate(feed_i) : 32'd0),
      .ratio_i(feed_pkg::ratio(feed_i)),
      .done_o(done),
      .on_o(on)
  );

  for (genvar n = 0; n < 2; n++) begin : gen_channel
    pwm_channel channel (
        .clk_i,
        .rst_i,
        .stop_i(stop[n]),
        .period_i(periods_q[n*27+:27]),
        .done_i(done[n]),
        .on_i(on),
        .due_o(due[n]),
        .pulse_o(pulse[n])
    );
  end

  // Outputs of a channel: all, those with a pulse now, those between pulses.
  logic [Outputs-1:0] carry;
  logic [Outputs-1:0] high;
  logic [Outputs-1:0] low;
  logic [        1:0] shown;

  assign shown = pulse & ~(follows &{2{still}});
  assign carry = outputs_q[Outputs+:Outputs] | outputs_q[0+:Outputs];
  assign high  = (outputs_q[Outputs+:Outputs] & {Outputs{shown[1]}}) | (outputs_q[0+:Outputs] & {Outputs{shown[0]}});
  assign low   = carry & ~high;
  assign pin_o = (level_i & ~low) | (idle_i & low);

  logic unused;  // bits for other blocks
  assign unused = &{1'b0, data, setting_i, load_i, feed_i};
endmodule
`default_nettype wire
