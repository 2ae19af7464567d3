"""Records: one JSON file for each complete run of a job of scripts/farm or of a part of scripts/test --long."""
