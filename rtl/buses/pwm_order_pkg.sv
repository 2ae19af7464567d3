// The settings that a PWM command gives to its channel.
`default_nettype none
package pwm_order_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int DUTY = 0;  // 16 bits
  localparam int GAIN = 16;  // 16 bits
  localparam int SHIFT = 32;  // 5 bits
  localparam int FOLLOWS = 37;  // the duty follows the speed on the path
  localparam int WIDTH = 38;

  function automatic logic [15:0] duty(input logic [WIDTH-1:0] order);
    duty = order[DUTY+:16];
  endfunction

  function automatic logic [15:0] gain(input logic [WIDTH-1:0] order);
    gain = order[GAIN+:16];
  endfunction

  function automatic logic [4:0] shift(input logic [WIDTH-1:0] order);
    shift = order[SHIFT+:5];
  endfunction

  // Packs the halfwords of the command, of which the first is lowest.
  function automatic logic [WIDTH-1:0] of_words(input logic [47:0] words);
    of_words = {words[4], words[12:8], words[47:32], words[31:16]};
  endfunction

endpackage
`default_nettype wire
