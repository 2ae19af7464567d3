"""scripts/coverage: what the locksteps reach in the RTL, and the unit tests in the C++ libraries."""
