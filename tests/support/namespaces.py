"""Programs in namespaces of their own, as `unshare --pid --fork` starts them."""

import os
import pathlib
import signal


def end(unshare):
    """Ends what a subprocess.Popen of unshare has started, with all its processes. Its --kill-child does not: the signal that
    a parent's death sends is cleared when the child changes its user. The child is the first process of its namespace; the
    kernel ends the others with it, stopped ones too."""
    for child in pathlib.Path(f"/proc/{unshare.pid}/task/{unshare.pid}/children").read_text().split():
        os.kill(int(child), signal.SIGKILL)
    unshare.wait(10)
