"""Where the comparisons write: found out before they measure for minutes."""

import argparse
import tempfile
from pathlib import Path


def writable_folder(text):
    """The folder of that name, made if it isn't there, for `argparse`; refused if nothing can be written there."""
    folder = Path(text)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        raise argparse.ArgumentTypeError(f"nothing can be written to {text}: {error.strerror}") from error
