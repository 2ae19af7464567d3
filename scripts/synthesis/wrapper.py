"""The wrapper that registers every input and output of a block.

Fmax is then the block's own, because no pin limits it: inputs come from a shift register, and outputs are folded bit by
bit into one pin. Ports for observation stay open, as on a board.
"""
from synthesis.tools import BUILD, ports

# Ports that exist only for the lockstep.
OBSERVATION = {
    "trammel_card": {"observe_o"},
}


def write_wrapper(name, block, parameters):
    """Writes the wrapper of a build; returns its file and its numbers of input and output bits."""
    used = [p for p in ports(block, parameters, BUILD / f"{name}.ports.log")
            if p[0] != "clk_i" and p[0] not in OBSERVATION.get(block, ())]
    inputs = [(n, w) for n, d, w in used if d == "input"]
    outputs = [(n, w) for n, d, w in used if d == "output"]
    n_in, n_out = sum(w for _, w in inputs), sum(w for _, w in outputs)
    connections, at = [".clk_i"], 0
    for port, width in inputs:
        connections.append(f".{port}(in_q[{at}+:{width}])")
        at += width
    at = 0
    for port, width in outputs:
        connections.append(f".{port}(out_d[{at}+:{width}])")
        at += width
    chosen = ", ".join(f".{name}({value})" for name, value in parameters.items())
    text = f"""module wrapper (input wire logic clk_i, input wire logic serial_i, output logic serial_o);
  logic [{n_in - 1}:0] in_q;
  logic [{n_out - 1}:0] out_d, out_q, fold_q;
  always_ff @(posedge clk_i) begin
    in_q <= {{in_q[{n_in - 2}:0], serial_i}};
    out_q <= out_d;
    fold_q <= {{fold_q[{n_out - 2}:0], 1'b0}} ^ out_q;
  end
  assign serial_o = fold_q[{n_out - 1}];
  {block} #({chosen}) u_block ({", ".join(connections)});
endmodule
"""
    file = BUILD / f"{name}.wrapper.sv"
    file.write_text(text)
    return f"build/synthesis/{name}.wrapper.sv", n_in, n_out
