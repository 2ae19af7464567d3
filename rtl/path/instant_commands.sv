// The effects that commands have at their place on the path besides motion: OUTPUT and MARK, and when PWM takes effect.
//
// The commands wait for the end of the path that runs as they are decoded, and then for the time that its last tick
// takes to the axes' steps. If no path runs, they wait for that time only. No command is decoded between a path's end
// and its effect, since a command takes 8 clocks; so one set of masks is enough.
`default_nettype none

module instant_commands #(
    parameter int Outputs = 4  // 1 to 16
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    // commands
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input wire logic take_output_i,  // OUTPUT is taken now; its last halfword is on load_i
    input wire logic take_mark_i,  // MARK is taken now
    input wire logic take_pwm_i,  // PWM is taken now
    input wire logic over_i,  // event: a path ended: its last tick was taken (lines), or its engine has finished
    input wire logic runs_i,  // a path is under way
    output logic mark_o,  // event: requests a snapshot
    output logic [31:0] marks_o,  // number of MARKs that have taken effect
    // the outputs' change
    output logic change_o,  // combinational: the commands that wait take effect, PWM too
    output logic [Outputs-1:0] set_o,
    output logic [Outputs-1:0] clear_o
);
  // Clocks from the take of a path's last tick to its step on the path.
  localparam logic [2:0] TO_STEP = 3'd6;

  // Masks of the command: set, then clear.
  logic [2*Outputs-1:0] words_q;
  logic                 merge_q;
  logic                 change_waits_q;  // an OUTPUT or PWM waits
  logic                 mark_waits_q;
  logic                 mark_due_q;
  logic [          2:0] delay_q;
  logic                 fire;
  logic [  Outputs-1:0] kept_set;  // bits of the masks that have not taken effect
  logic [  Outputs-1:0] kept_clear;

  logic [         15:0] word;

  assign word = load_bus_pkg::word(load_i);
  assign {kept_set, kept_clear} = change_o ? '0 : {set_o, clear_o};
  assign fire = (change_waits_q || mark_waits_q) && delay_q == 3'd0 && (over_i || !runs_i);
  assign change_o = delay_q == 3'd1 && !cut_i;

  // Masks that have taken effect are cleared: a cause may give the outputs other levels before the next command.
  always_ff @(posedge clk_i) begin
    words_q <= {word[Outputs-1:0], words_q[2*Outputs-1:Outputs]};
    merge_q <= take_output_i;
    {set_o, clear_o} <= {kept_set, kept_clear};
    if (merge_q) begin
      set_o   <= (kept_set & ~words_q[2*Outputs-1:Outputs]) | words_q[Outputs-1:0];
      clear_o <= kept_clear | words_q[2*Outputs-1:Outputs];
    end
    change_waits_q <= take_output_i || take_pwm_i || (change_waits_q && !fire);
    mark_waits_q   <= take_mark_i || (mark_waits_q && !fire);
    if (fire) mark_due_q <= mark_waits_q;
    if (fire) delay_q <= TO_STEP;
    else if (delay_q != 3'd0) delay_q <= delay_q - 3'd1;
    if (cut_i || rst_i) begin
      merge_q <= 1'b0;
      set_o <= '0;
      clear_o <= '0;
      change_waits_q <= 1'b0;
      mark_waits_q <= 1'b0;
      delay_q <= 3'd0;
    end
  end

  // MARKs taken, and MARKs that have taken effect.
  logic [31:0] taken_q;

  always_ff @(posedge clk_i) begin
    mark_o <= change_o && mark_due_q && !rst_i;
    if (change_o && mark_due_q) marks_o <= taken_q;
    if (cut_i) taken_q <= marks_o;
    else if (take_mark_i) taken_q <= taken_q + 32'd1;
    if (rst_i) begin
      taken_q <= '0;
      marks_o <= '0;
    end
  end

  logic unused;
  assign unused = &{1'b0, word};
endmodule

`default_nettype wire
