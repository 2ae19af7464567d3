"""The error that readers of the descriptions raise."""


class DescriptionError(Exception):
    """An error in the files of rtl/regs; scripts/generate-registers prints its text and writes nothing."""
