"""What the scripts share about the RTL."""
