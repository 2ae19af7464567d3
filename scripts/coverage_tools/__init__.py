"""scripts/coverage: coverage of the RTL by the locksteps, and of the C++ libraries by the unit tests."""
