"""Synthesis, place and route: scripts/synthesise and scripts/replay-netlist."""
