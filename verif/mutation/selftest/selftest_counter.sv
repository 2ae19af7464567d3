// For the test of scripts/mutate: the test compares count_o, and nothing compares unseen_q.
`default_nettype none

module selftest_counter (
    input  wire logic       clk_i,
    input  wire logic       rst_i,
    input  wire logic       step_i,
    output logic      [3:0] count_o
);
  typedef enum logic [1:0] {
    REST,
    ODD,
    EVEN
  } state_e;

  state_e       state_q;
  logic   [3:0] unseen_q;

  always_ff @(posedge clk_i) begin
    if (step_i) begin
      case (state_q)
        ODD: state_q <= EVEN;
        default: state_q <= ODD;
      endcase
      count_o <= {count_o[3:1] + {2'd0, state_q == ODD}, state_q != ODD};
    end
    unseen_q <= count_o + 4'd1;
    if (rst_i) begin
      state_q <= REST;
      count_o <= '0;
    end
  end

  logic unused;
  assign unused = ^unseen_q;
endmodule

`default_nettype wire
