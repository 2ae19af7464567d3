// Signals from the card to a Wishbone B4 master; each field is the Wishbone signal of that name.
`default_nettype none
package wishbone_answer_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int DAT = 0;  // 32 bits: data of a read
  localparam int STALL = 32;  // 0 if the port is classic
  localparam int ERR = 33;
  localparam int ACK = 34;
  localparam int WIDTH = 35;

endpackage
`default_nettype wire
