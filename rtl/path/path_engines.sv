// What makes steps from ticks beside the axes' own generators: prescaler, engines and router as one socket.
//
// All paths share one domain of ticks and swaps, those of the feed as late as the prescaler's steps, so that a path on
// prescaled ticks and a line after it cannot overtake each other.
`default_nettype none

module path_engines #(
    parameter int Axes        = 4,
    parameter bit Accumulator = 1
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic            cut_i,
    input  wire logic            tick_i,
    input  wire logic            swap_i,
    input  wire logic            engine_i,         // with swap_i, what the path runs on: 0 lines, 1 accumulator
    input  wire logic            start_i,          // with swap_i: the engine's state is loaded
    input  wire logic [    21:0] load_i,
    output logic                 tick_o,           // path domain, to the axes
    output logic                 swap_o,
    output logic                 path_tick_o,      // the accumulator's tick
    output logic      [Axes-1:0] step_o,
    output logic      [Axes-1:0] dir_o,
    output logic                 ready_o,          // a tick may be taken
    output logic                 payload_ready_o,  // the engine's state may be loaded
    output logic                 done_o,           // every path tick given is finished
    output logic                 elsewhere_o       // with done_o: not on the commanded end point
);
  logic [2:0] tick_q;
  logic [2:0] swap_q;

  assign tick_o = tick_q[2];
  assign swap_o = swap_q[2];

  always_ff @(posedge clk_i) begin
    tick_q <= {tick_q[1:0], tick_i};
    swap_q <= {swap_q[1:0], swap_i};
    if (rst_i || cut_i) begin
      tick_q <= '0;
      swap_q <= '0;
    end
  end

  if (Accumulator) begin : gen_accumulator
    logic on_engine_q;
    logic coming;
    logic prescaler_step;
    logic engine_ready;
    logic engine_stepping;
    logic at_end;
    logic step_x;
    logic dir_x;
    logic step_y;
    logic dir_y;

    // Ticks of other paths pass without a step of the prescaler.
    assign coming = on_engine_q && (tick_i || tick_q != '0);

    always_ff @(posedge clk_i) begin
      if (swap_i) on_engine_q <= engine_i;
      elsewhere_o <= !at_end;
      if (rst_i || cut_i) on_engine_q <= 1'b0;
    end

    pulse_generator #(
        .Counted(0)
    ) prescaler (
        .*,
        .clear_i         (cut_i),
        .active_i        (engine_i),
        .counted_i       (1'b0),
        .mirror_i        (1'b0),
        .load_increment_i(load_i[21] && load_i[20:16] == load_target_pkg::PRESCALE),
        .load_count_i    (1'b0),
        .word_i          (load_i[15:0]),
        .step_o          (prescaler_step),
        .dir_o           (),
        .live_o          ()
    );

    path_tick_gate gate (
        .*,
        .coming_i         (coming),
        .step_i           (prescaler_step),
        .engine_ready_i   (engine_ready),
        .engine_stepping_i(engine_stepping),
        .tick_o           (path_tick_o)
    );

    deviation_accumulator accumulator (
        .*,
        .clear_i   (cut_i),
        .tick_i    (path_tick_o),
        .step_x_o  (step_x),
        .dir_x_o   (dir_x),
        .step_y_o  (step_y),
        .dir_y_o   (dir_y),
        .ready_o   (engine_ready),
        .stepping_o(engine_stepping),
        .at_end_o  (at_end)
    );

    // The accumulator's steps go to the two axes of the arc's plane. The plane is loaded with the arc, that is when no
    // other arc runs, so that one register is enough.
    logic [2:0] axis_x_q;
    logic [2:0] axis_y_q;

    always_ff @(posedge clk_i) begin
      if (load_i[21] && load_i[20:16] == load_target_pkg::PLANE) begin
        axis_x_q <= load_i[6:4];
        axis_y_q <= load_i[10:8];
      end
      // A direction is looked at with its step only.
      step_o <= '0;
      if ((step_x || step_y) && !rst_i) begin
        for (int i = 0; i < Axes; i++) begin
          step_o[i] <= (step_x && axis_x_q == 3'(i)) || (step_y && axis_y_q == 3'(i));
          dir_o[i]  <= (axis_x_q == 3'(i)) ? dir_x : dir_y;
        end
      end
    end
  end else begin : gen_lines_only
    assign path_tick_o     = 1'b0;
    assign step_o          = '0;
    assign dir_o           = '0;
    assign ready_o         = 1'b1;
    assign payload_ready_o = 1'b1;
    assign done_o          = 1'b1;
    assign elsewhere_o     = 1'b0;

    logic unused;
    assign unused = &{1'b0, engine_i, start_i, load_i};
  end
endmodule

`default_nettype wire
