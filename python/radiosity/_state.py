"""Where view factors stand, in a file: what a run that ends early leaves, and the next goes on from.

The engine says when its work can be put down; what ends a run, an exception of the progress function or Ctrl-C among
them, waits until then. Invariant: the file is a whole state, of this work, or it is not there: a new one is written
beside it and takes its name. Where none can be written the work does not begin; where none can be any more, it goes on
without, and a warning says so.
SPDX-License-Identifier: MIT
"""
import os
import time

from ._device import InvalidInput
from ._engine import ffi, lib

EVERY = 10  # s between states; and no more than a twentieth of the time


class State:
    """The engine's view of the file. told: what the call that goes on from it has to tell (_device)."""

    def __init__(self, path):
        self.path, self.told = os.fsdecode(path), None
        if not self.path:
            raise InvalidInput("resume is an empty name; give that of a file, or None for no file")
        self.stop = False  # somebody wants no more
        self.begun = False  # something was read: what is refused then is the file
        self._broken = None  # why no state can be written
        self._in = self._out = None
        self._saved = time.monotonic()
        self._took = 0
        self._user = ffi.new_handle(self)
        self.host = ffi.new("struct RadExchangeState *")
        self.host.user = self._user
        self.host.asked = lib.radiosity_state_asked
        self.host.write = lib.radiosity_state_write

    def __enter__(self):
        try:
            self._in = open(self.path, "rb")
        except FileNotFoundError:
            pass
        else:
            self.host.read = lib.radiosity_state_read
        try:  # hours of work are not begun for a file that cannot be
            with self._beside() as file:
                os.unlink(file.name)
        except OSError as error:
            if self._in:
                self._in.close()
            raise type(error)(error.errno, error.strerror, self.path) from None
        return self

    def _beside(self):
        return open(f"{self.path}.{os.getpid()}.tmp", "wb")

    def __exit__(self, *_):
        if self._in:
            self._in.close()
        self._discard()
        self._user = None  # a circle

    def read(self, room):
        self.begun = True
        return self._in.readinto(room)

    def asked(self):
        self._discard()  # what an exception has left unfinished
        now = time.monotonic()
        if self.stop or self.told.failure is not None:
            return lib.RAD_STATE_STOP
        due = not self._broken and now - self._saved > max(EVERY, 20 * self._took)
        return lib.RAD_STATE_SAVE if due else lib.RAD_STATE_NONE

    def write(self, data):
        """The next bytes; None: there are no more. Returns 0, or -1: there will be no state."""
        try:
            if not self._out:
                self._began = time.monotonic()
                self._out = self._beside()
            if data is not None:
                self._out.write(data)
                return 0
            self._out.close()
            os.replace(self._out.name, self.path)
        except OSError as error:
            if not self._broken:
                self.told.warnings.append(f"the state cannot be written to {self.path}: {error.strerror}")
            self._broken = error
            self._discard()
            return -1
        self._out = None
        self._saved = time.monotonic()
        self._took = self._saved - self._began
        return 0

    def _discard(self):
        if self._out:
            self._out.close()
            os.unlink(self._out.name)
        self._out = None

    def remove(self):
        """The work is done."""
        if os.path.exists(self.path):
            os.unlink(self.path)
