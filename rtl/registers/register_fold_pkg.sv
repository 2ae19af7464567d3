// The place of each word of the map in the block RAM of the registers. The address window has room for units that are
// not built, but the RAM holds only the ranges that are built: 256 words; 512 if the card has more than 4 axes, machine
// inputs or enables; 1,024 if it has more than 4 axes and captures, enables or soft limits.
//
//   00_0000_iiii  identity, word i                    00_001g_ggii  settings, group g, word i
//   00_0001_iiii  latched values of REST, word i
//   00_01dd_dddd  descriptors with up to 4 axes       01_00dd_dddd  descriptors with more
//   00_10aa_iiii  latched values, area a, word i      00_11nn_niii  axis n, word i
//   00_111w_wwww  direct mode with up to 4 axes       00_01ww_wwww  direct mode with more
//   01_0www_wwww  filters and roles, up to 4 axes     01_1www_wwww  filters and roles with more
//   01_10kk_iiii  capture k, word i, up to 4 axes     10_00kk_iiii  capture k with more
//   01_10ww_11vv  captures' setting vvww, up to 4     10_0110_vvww  with more
//   01_1110_iiii  enables, up to 4 axes              10_0100_iiii  enables with more
//   01_1111_nnni  soft limits of axis n, up to 4      10_0101_nnni  soft limits with more
//
// With up to 4 axes a capture uses 12 of its 16 words, and the settings of the captures use the other four. All words
// that are written lie in the lower 256, except for filters, roles, captures, enables and soft limits. Without those,
// the sweep after a reset takes the same time with any number of axes.
`default_nettype none
package register_fold_pkg;

  function automatic logic [9:0] place_of(input logic [9:0] word, input logic more_axes);
    case (word[9:8])
      2'b00:
      if (word[7]) place_of = {4'b0010, word[6:5], word[3:0]};
      else if (word[6]) place_of = {more_axes ? 4'b0100 : 4'b0001, word[5:0]};
      else place_of = {6'b000000, word[3:0]};
      2'b01:
      if (word[7:4] == 4'b1110 && word[3:2] != 2'b00) place_of = {more_axes ? 6'b100100 : 6'b011110, word[3:0]};
      else if (word[7]) place_of = {5'b00001, word[6:4], word[1:0]};
      else if (word[6:5] == 2'b00) place_of = {6'b000001, word[3:0]};
      else if (word[6:5] == 2'b11)
        place_of = more_axes ? {6'b100110, word[3:0]} : {4'b0110, word[1:0], 2'b11, word[3:2]};
      else place_of = {more_axes ? 4'b1000 : 4'b0110, word[6], word[4:0]};
      2'b10:
      if (word[3]) place_of = {more_axes ? 6'b100101 : 6'b011111, word[7:5], word[0]};
      else place_of = {4'b0011, word[7:5], word[2:0]};
      default:
      if (word[7]) place_of = {2'b01, more_axes, word[6:0]};
      else place_of = more_axes ? {4'b0001, word[5:0]} : {5'b00111, word[4:0]};
    endcase
  endfunction

  function automatic logic is_identity(input logic [9:0] place);
    is_identity = place[9:4] == 6'b000000;
  endfunction

  function automatic logic is_descriptor(input logic [9:0] place, input logic more_axes);
    is_descriptor = place[9:6] == (more_axes ? 4'b0100 : 4'b0001);
  endfunction

  function automatic logic is_setting(input logic [9:0] place);
    is_setting = place[9:5] == 5'b00001;
  endfunction

  // The map's word at a place for which is_setting() is true.
  function automatic logic [9:0] setting_word(input logic [9:0] place);
    setting_word = {3'b011, place[4:2], 2'b00, place[1:0]};
  endfunction

endpackage
`default_nettype wire
