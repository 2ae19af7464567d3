"""Code about the RTL that the scripts share."""
