// Test bench: reads MAGIC and CLOCK_HZ through the SoC's UART bridge, writes a setting and reads it back. A request is
// a command (1 write, 2 read), the number of words, and the word address, most significant byte first. Data words also
// have their most significant byte first.
module read_magic;
  localparam int BIT = 16;  // clocks per bit
  logic clk = 0;
  logic rst = 1;
  logic rx = 1;
  wire tx;
  logic [3:0] step;
  logic [3:0] dir;
  always #1 clk = !clk;

  trammel_soc soc (
      .clk(clk),
      .rst(rst),
      .serial_rx(rx),
      .serial_tx(tx),
      .motors_step(step),
      .motors_dir(dir)
  );

  task send(input [7:0] value);
    rx = 0;
    repeat (BIT) @(posedge clk);
    for (int i = 0; i < 8; i++) begin
      rx = value[i];
      repeat (BIT) @(posedge clk);
    end
    rx = 1;
    repeat (2 * BIT) @(posedge clk);
  endtask

  task send_word(input [31:0] value);
    for (int i = 3; i >= 0; i--) send(value[8*i+:8]);
  endtask

  // Receives bytes from the SoC continuously.
  logic [7:0] got[0:15];
  int count = 0;
  logic good = 1;
  always begin
    @(negedge tx);
    repeat (BIT + BIT / 2) @(posedge clk);
    for (int i = 0; i < 8; i++) begin
      got[count][i] = tx;
      repeat (BIT) @(posedge clk);
    end
    count = count + 1;
  end

  task read(input [31:0] address, input [31:0] expected);
    count = 0;
    send(8'h02);
    send(8'h01);
    send_word(address >> 2);
    repeat (100 * BIT) @(posedge clk);
    $display("%h: %0d bytes, %h %h %h %h", address, count, got[0], got[1], got[2], got[3]);
    if (count != 4 || {got[0], got[1], got[2], got[3]} !== expected) begin
      $display("error: expected %h", expected);
      good = 0;
    end
  endtask

  task write(input [31:0] address, input [31:0] value);
    send(8'h01);
    send(8'h01);
    send_word(address >> 2);
    send_word(value);
  endtask

  initial begin
    repeat (10) @(posedge clk);
    rst = 0;
    repeat (400) @(posedge clk);
    read(32'h3000_0000, 32'h5452_4D4C);  // MAGIC
    read(32'h3000_000C, 32'd80_000_000);  // CLOCK_HZ
    write(32'h3000_0000 + 32'(card_map_pkg::ADDR_STEP_LENGTH), 32'd123);  // of axis 0
    read(32'h3000_0000 + 32'(card_map_pkg::ADDR_STEP_LENGTH), 32'd123);
    if (good) $display("all as expected");
    $finish;
  end
endmodule
