// Where the block RAM of the registers holds a word of the map. The window has room for what is not built, so the RAM
// holds the built ranges alone: 256 words, or 512 where the card has more than 4 axes.
//
//   0_0000_iiii  identity, word i                     0_001g_ggii  settings, group g, word i
//   0_01dd_dddd  descriptors with up to 4 axes        1_00dd_dddd  descriptors with more
//   0_10aa_iiii  latched values, area a, word i       0_11nn_niii  axis n, word i
//   0_111w_wwww  direct mode with up to 4 axes        0_01ww_wwww  direct mode with more
//
// All that is written lies in the lower 256 words, so that the sweep after reset takes the same time with any axes.
`default_nettype none
package register_fold_pkg;

  function automatic logic [8:0] place_of(input logic [9:0] word, input logic more_axes);
    case (word[9:8])
      2'b00:
      if (word[7]) place_of = {3'b010, word[6:5], word[3:0]};
      else if (word[6]) place_of = {more_axes ? 3'b100 : 3'b001, word[5:0]};
      else place_of = {5'b00000, word[3:0]};
      2'b01: place_of = {4'b0001, word[6:4], word[1:0]};
      2'b10: place_of = {3'b011, word[7:5], word[2:0]};
      default: place_of = more_axes ? {3'b001, word[5:0]} : {4'b0111, word[4:0]};
    endcase
  endfunction

  function automatic logic is_identity(input logic [8:0] place);
    is_identity = place[8:4] == 5'b00000;
  endfunction

  function automatic logic is_descriptor(input logic [8:0] place, input logic more_axes);
    is_descriptor = place[8:6] == (more_axes ? 3'b100 : 3'b001);
  endfunction

  function automatic logic is_setting(input logic [8:0] place);
    is_setting = place[8:5] == 4'b0001;
  endfunction

  // The word of the map at a place that is_setting().
  function automatic logic [9:0] setting_word(input logic [8:0] place);
    setting_word = {3'b011, place[4:2], 2'b00, place[1:0]};
  endfunction

endpackage
`default_nettype wire
