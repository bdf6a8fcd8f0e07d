"""A device of the engine for each scene: calls, and what comes of them as Python has it.

Invariant: an exception that a progress function raises, Ctrl-C among them, leaves the call that it was raised in,
and the engine is not asked again about what was cancelled. Handles are released when nobody holds them any more;
the engine keeps alive what a handle was made from. What the engine calls back with is `_Told`, which knows of no
handle, so that there is no circle.
SPDX-License-Identifier: MIT
"""
import threading
import types
import warnings

from ._engine import ffi, lib


class RadiosityError(RuntimeError):
    """The engine cannot do what was asked; the text says why, and how to mend it."""


class InvalidInput(RadiosityError, ValueError):
    """A value out of range, a name that nobody has, faces that light cannot be computed for."""


class OutOfMemory(RadiosityError, MemoryError):
    """There is not enough memory."""


class Cancelled(RadiosityError):
    """A progress function returned something true."""


class RadiosityWarning(UserWarning):
    """The engine has mended what it was given, or tells what a result lacks."""


_CLASSES = {
    lib.RAD_ERROR_INVALID_ARGUMENT: InvalidInput,
    lib.RAD_ERROR_INVALID_SCENE: InvalidInput,
    lib.RAD_ERROR_INVALID_ORACLE: InvalidInput,
    lib.RAD_ERROR_OUT_OF_MEMORY: OutOfMemory,
    lib.RAD_ERROR_CANCELLED: Cancelled,
}


class _Told:
    def __init__(self):
        self.progress = None
        self.failure = None
        self.warnings = []
        self.state = None  # of a call that can be gone on with


_running = threading.local()  # .told: of the call that this thread is in


def _keep_failure(_kind, failure, _trace):
    """An exception within a callback, or a signal before it began: to be raised once the engine has returned.

    Where the work is to be gone on with it ends when it can be put down, else at once.
    """
    _running.told.failure = failure
    return 0 if _running.told.state else 1


@ffi.def_extern(onerror=_keep_failure, error=1)
def radiosity_progress(user, progress):
    told = ffi.from_handle(user)
    if told.progress is None or told.failure is not None or (told.state and told.state.stop):
        return 0
    stop = bool(told.progress(as_namespace(progress[0])))
    if told.state:
        told.state.stop = stop
        return 0
    return int(stop)


def _keep_in_state(_kind, failure, _trace):
    _running.told.failure = failure


@ffi.def_extern(onerror=_keep_in_state, error=0)
def radiosity_state_read(user, room, size):
    return ffi.from_handle(user).read(ffi.buffer(room, size))


@ffi.def_extern(onerror=_keep_in_state, error=lib.RAD_STATE_STOP)
def radiosity_state_asked(user):
    return ffi.from_handle(user).asked()


@ffi.def_extern(onerror=_keep_in_state, error=-1)
def radiosity_state_write(user, data, size):
    return ffi.from_handle(user).write(None if data == ffi.NULL else ffi.buffer(data, size))


def as_namespace(value):
    """A struct of the engine's as an object with its members."""
    def convert(item):
        if not isinstance(item, ffi.CData):
            return item
        kind = ffi.typeof(item)
        if kind.kind == "struct":
            return as_namespace(item)
        if kind.kind == "array":
            return tuple(convert(one) for one in item)
        return ffi.string(item).decode()  # const char *
    return types.SimpleNamespace(
        **{name: convert(getattr(value, name)) for name, _ in ffi.typeof(value).fields})


class Device:
    def __init__(self, threads):
        options = ffi.new("struct RadDeviceOptions *")
        options.threads = threads
        handle = lib.radNewDevice(options)
        if handle == ffi.NULL:
            message = ffi.string(lib.radGetDeviceErrorMessage(ffi.NULL)).decode()
            raise _CLASSES.get(lib.radGetDeviceError(ffi.NULL), RadiosityError)(message)
        self.handle = ffi.gc(handle, lib.radReleaseDevice)
        self._told = _Told()
        self._user = ffi.new_handle(self._told)
        self._lock = threading.Lock()
        self._owner = None
        lib.radSetDeviceProgressFunction(self.handle, lib.radiosity_progress, self._user)

    def call(self, function, *arguments, progress=None, release=None, resume=None):
        """function(*arguments), with its error as an exception; a handle is given up by `release`.

        resume: the State that its work goes on from, or ends in.
        """
        if self._owner == threading.get_ident():
            raise RadiosityError("a progress function cannot ask the scene whose work it is told of; "
                                 "return something true to end that work, and ask then")
        told = self._told
        with self._lock:
            self._owner = threading.get_ident()
            told.progress, told.failure, told.warnings, told.state = progress, None, [], resume
            if resume:
                resume.told = told
            _running.told = told
            try:
                result = function(*arguments)
                if release:
                    failed = result == ffi.NULL
                    result = None if failed else ffi.gc(result, release)
                else:
                    failed = result is not None and result < 0
                message = ffi.string(lib.radGetDeviceErrorMessage(self.handle)).decode(errors="replace").strip()
                code = lib.radGetDeviceError(self.handle)
                failure, said = told.failure, told.warnings
            finally:
                self._owner = _running.told = told.progress = told.failure = told.state = None
        for text in said:
            warnings.warn(text, RadiosityWarning, stacklevel=3)
        if failure is not None:
            raise failure
        if failed and resume and resume.begun and code == lib.RAD_ERROR_INVALID_ARGUMENT:
            raise InvalidInput(f"{resume.path}: {message}; remove it to start anew, or give another name")
        if failed:
            raise _CLASSES.get(code, RadiosityError)(message or "the engine failed and did not say why")
        return result


def choose(what, name, choices):
    """The number that a name stands for."""
    if name not in choices:
        raise InvalidInput(f"{what} is {name!r}; it can be {', '.join(map(repr, choices))}")
    return choices[name]
