"""The fault that readers of the descriptions report."""


class DescriptionError(Exception):
    """A fault in the files of rtl/regs; scripts/generate-registers prints its text and writes nothing."""
