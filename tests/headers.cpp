// Has nothing of its own: the target that it stands in compiles the test headers once.
