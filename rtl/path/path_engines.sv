// The blocks that make steps from ticks, besides the axes' own generators: the engines and the socket that they share.
// The socket is a prescaler with a gate that gives its ticks to the path's engine one at a time.
//
// All paths share one domain of ticks and swaps. Those of the feed are delayed as much as the prescaler's steps, so
// that a path on prescaled ticks and a line after it cannot overtake each other. On the arc generator the axes get the
// prescaler's ticks, one clock after the generator.
`default_nettype none

module path_engines #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic tick_i,
    input wire logic [move_pkg::WIDTH-1:0] move_i,  // at its SWAP the state of the engine, except for lines, is loaded
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    output logic [axis_drive_pkg::WIDTH-1:0] drive_o,  // path domain
    output logic path_tick_o,  // a tick of an engine
    output logic ready_o,  // a feed tick may be taken
    output logic payload_ready_o,  // the engine's state may be loaded
    output logic quiet_o,  // no path tick waits or is on its way to an engine, and no engine is making a step
    output logic shadows_free_o,  // the axes' increments may be loaded
    output logic done_o,  // every path tick given is finished
    output logic missed_end_o  // with done_o: the path ended away from its commanded end point
);
  localparam logic [4:0] LINES = 5'(card_map_pkg::ENGINE_LINES);
  localparam logic [4:0] ACCUMULATOR = 5'(card_map_pkg::ENGINE_ACCUMULATOR);
  localparam logic [4:0] ARC_GENERATOR = 5'(card_map_pkg::ENGINE_ARC_GENERATOR);
  // Engines that take the prescaler's ticks.
  localparam logic [31:0] TICKED = 32'd1 << ACCUMULATOR | 32'd1 << ARC_GENERATOR;

  logic [4:0] engine;  // engine of the path that begins
  logic swap;
  logic taking;  // the path still takes feed ticks

  assign engine = move_pkg::engine(move_i);
  assign swap   = move_i[move_pkg::SWAP];
  assign taking = move_i[move_pkg::TAKING];

  logic [     2:0] tick_q;
  logic [     2:0] swap_q;
  logic            axes_tick_q;
  logic [     1:0] own_tick_q;  // feed ticks for the axes
  logic            axes_run;  // the axes run on feed ticks
  logic            chord_tick;  // a path tick for the axes

  logic [Axes-1:0] step;
  logic [Axes-1:0] dir;
  logic [    15:0] chord_word;
  logic [Axes-1:0] chord_load;
  logic [Axes-1:0] chord_swap;

  assign drive_o[axis_drive_pkg::TICK] = axes_tick_q;
  assign drive_o[axis_drive_pkg::SWAP] = swap_q[2];
  assign drive_o[axis_drive_pkg::STEP+:8] = 8'(step);
  assign drive_o[axis_drive_pkg::DIR+:8] = 8'(dir);
  assign drive_o[axis_drive_pkg::CHORD_WORD+:16] = chord_word;
  assign drive_o[axis_drive_pkg::CHORD_LOAD+:8] = 8'(chord_load);
  assign drive_o[axis_drive_pkg::CHORD_SWAP+:8] = 8'(chord_swap);

  always_ff @(posedge clk_i) begin
    tick_q <= {tick_q[1:0], tick_i};
    own_tick_q <= {own_tick_q[0], tick_i && axes_run};
    axes_tick_q <= own_tick_q[1] || chord_tick;
    swap_q <= {swap_q[1:0], swap};
    if (rst_i || cut_i) begin
      own_tick_q <= '0;
      axes_tick_q <= 1'b0;
      swap_q <= '0;
    end
  end

  if ((Engines & TICKED) != 32'd0) begin : gen_engines
    logic [       4:0] engine_q;  // engine of the path
    logic              coming;
    logic              prescaler_step;
    // State of an engine, from registers: {stepping, at its end, ready, dir, step}. Its steps leave before it is ready.
    logic [2*Axes+2:0] accumulator;
    logic              on_arc;
    logic              arc_ready;
    logic              gate_ready;
    logic              engine_stepping;
    logic              at_end;
    logic              engine_ready;

    // State of the engine on which the path runs.
    always_comb begin
      case (engine_q)
        // The axes make the steps, and the path ends where they end.
        LINES, ARC_GENERATOR: {engine_stepping, at_end, engine_ready, dir, step} = (2 * Axes + 3)'(2'b11) << 2 * Axes;
        default: {engine_stepping, at_end, engine_ready, dir, step} = accumulator;
      endcase
    end

    // Ticks of lines pass without a step of the prescaler.
    assign coming = engine_q != LINES && (tick_i || tick_q != '0);
    assign ready_o = gate_ready && arc_ready;
    assign payload_ready_o = quiet_o && shadows_free_o;
    assign axes_run = !on_arc;
    assign chord_tick = on_arc && prescaler_step;

    always_ff @(posedge clk_i) begin
      if (swap) engine_q <= engine;
      missed_end_o <= !at_end;
      if (rst_i || cut_i) engine_q <= LINES;
    end

    pulse_generator #(
        .Counted(0)
    ) prescaler (
        .clk_i,
        .rst_i,
        .clear_i(cut_i),
        .tick_i,
        .swap_i(swap),
        .chord_i(1'b0),
        .active_i(engine != LINES),
        .counted_i(1'b0),
        .mirror_i(1'b0),
        .load_increment_i(load_bus_pkg::to(load_i, load_target_pkg::PRESCALE)),
        .load_count_i(1'b0),
        .word_i(load_bus_pkg::word(load_i)),
        .step_o(prescaler_step),
        .dir_o(),
        .live_o()
    );

    path_tick_gate gate (
        .clk_i,
        .rst_i,
        .cut_i,
        .coming_i(coming),
        .step_i(prescaler_step && !on_arc),
        .engine_ready_i(engine_ready),
        .engine_stepping_i(engine_stepping),
        .tick_o(path_tick_o),
        .ready_o(gate_ready),
        .payload_ready_o(quiet_o),
        .done_o
    );

    if (Engines[ACCUMULATOR]) begin : gen_accumulator
      logic [Axes-1:0] step_q;
      logic [Axes-1:0] dir_q;
      logic            step_x;
      logic            dir_x;
      logic            step_y;
      logic            dir_y;
      logic [     2:0] axis_x_q;
      logic [     2:0] axis_y_q;
      logic [    15:0] word;

      assign word = load_bus_pkg::word(load_i);

      logic unused;
      assign unused = &{1'b0, word};

      deviation_accumulator #(
          .EightDirections(32'(Engines[card_map_pkg::ENGINE_ACCUMULATOR_8]))
      ) deviation (
          .clk_i,
          .rst_i,
          .clear_i(cut_i),
          .load_i,
          .start_i(swap && engine == ACCUMULATOR),
          .tick_i(path_tick_o && engine_q == ACCUMULATOR),
          .step_x_o(step_x),
          .dir_x_o(dir_x),
          .step_y_o(step_y),
          .dir_y_o(dir_y),
          .ready_o(accumulator[2*Axes]),
          .stepping_o(accumulator[2*Axes+2]),
          .at_end_o(accumulator[2*Axes+1])
      );

      // Its steps go to the two axes of the arc's plane. The plane is loaded with the arc, when no other arc runs, so
      // one register is enough.
      always_ff @(posedge clk_i) begin
        if (load_bus_pkg::to(load_i, load_target_pkg::PLANE)) begin
          axis_x_q <= word[6:4];
          axis_y_q <= word[10:8];
        end
        // A direction is used only with its step.
        step_q <= '0;
        if ((step_x || step_y) && !rst_i) begin
          for (int i = 0; i < Axes; i++) begin
            step_q[i] <= (step_x && axis_x_q == 3'(i)) || (step_y && axis_y_q == 3'(i));
            dir_q[i]  <= (axis_x_q == 3'(i)) ? dir_x : dir_y;
          end
        end
      end

      assign accumulator[2*Axes-1:0] = {dir_q, step_q};
    end else begin : gen_no_accumulator
      assign accumulator = '0;
    end

    if (Engines[ARC_GENERATOR]) begin : gen_arc_generator
      logic over_q;  // the arc has given its last path tick, also to the generator

      assign on_arc = engine_q == ARC_GENERATOR;
      // Only while the arc is under way: the next arc may start while engine_q still has this one's number.
      always_ff @(posedge clk_i) over_q <= !taking && !coming && !shadows_free_o;

      arc_generator #(
          .Axes(Axes)
      ) arc (
          .clk_i,
          .rst_i,
          .clear_i(cut_i || over_q),
          .load_i,
          .start_i(swap && engine == ARC_GENERATOR),
          .tick_i(chord_tick),
          .chord_word_o(chord_word),
          .chord_load_o(chord_load),
          .chord_swap_o(chord_swap),
          .ready_o(arc_ready),
          .loadable_o(shadows_free_o)
      );
    end else begin : gen_no_arc_generator
      assign on_arc         = 1'b0;
      assign arc_ready      = 1'b1;
      assign chord_word     = '0;
      assign chord_load     = '0;
      assign chord_swap     = '0;
      assign shadows_free_o = 1'b1;

      logic unused;
      assign unused = &{1'b0, taking};
    end
  end else begin : gen_lines_only
    assign path_tick_o     = 1'b0;
    assign step            = '0;
    assign dir             = '0;
    assign ready_o         = 1'b1;
    assign payload_ready_o = 1'b1;
    assign quiet_o         = 1'b1;
    assign done_o          = 1'b1;
    assign missed_end_o    = 1'b0;
    assign chord_word      = '0;
    assign chord_load      = '0;
    assign chord_swap      = '0;
    assign shadows_free_o  = 1'b1;
    assign axes_run        = 1'b1;
    assign chord_tick      = 1'b0;

    logic unused;
    assign unused = &{1'b0, engine, taking, load_i, tick_q};
  end
endmodule

`default_nettype wire
