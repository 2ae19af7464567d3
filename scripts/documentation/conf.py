# Sphinx's settings for the site (scripts/site).
project = "Trammel"
extensions = ["myst_parser"]
myst_heading_anchors = 4
html_theme = "furo"
html_title = "Trammel"
html_show_sphinx = False
html_copy_source = False
