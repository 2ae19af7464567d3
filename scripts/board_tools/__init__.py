"""Boards: their descriptions, what is written from them, and their bitstreams (scripts/boards)."""
