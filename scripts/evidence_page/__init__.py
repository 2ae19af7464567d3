"""One page that shows the evidence: which judge judged which module, in which run, and with which result."""
