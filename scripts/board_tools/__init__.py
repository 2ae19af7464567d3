"""Boards: their descriptions, the files generated from them, and their bitstreams (scripts/boards)."""
