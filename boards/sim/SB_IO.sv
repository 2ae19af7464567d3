// Stands for an iCE40's pin in simulation, as far as boards/rtl uses it: an output from the pin's flip-flop, inverted or not.
`default_nettype none

module SB_IO #(
    parameter logic [5:0] PIN_TYPE = 6'b01_01_01
) (
    input  wire logic OUTPUT_CLK,
    input  wire logic D_OUT_0,
    output logic      PACKAGE_PIN
);
  if (PIN_TYPE[5:4] != 2'b01 || !PIN_TYPE[2]) begin : gen_wrong_type
    ERROR_PIN_TYPE_must_be_an_output_from_the_flip_flop error ();
  end

  logic out_q = 1'b0;
  always_ff @(posedge OUTPUT_CLK) out_q <= D_OUT_0;
  assign PACKAGE_PIN = out_q ^ PIN_TYPE[3];

  logic unused;
  assign unused = &{1'b0, PIN_TYPE[1:0]};
endmodule

`default_nettype wire
