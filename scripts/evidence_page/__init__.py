"""One page that shows the evidence: what judged which module, in which run, and with which result."""
