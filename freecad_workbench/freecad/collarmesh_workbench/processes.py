"""Processes of Qt that may outlive what started them.

Qt frees a process from its main loop, after everything else has let go of it. What its connections hold ends in the
middle of that, and a parent among it would free the process a second time. So the application is the parent of all of
them, and nothing is connected any more to one that ends."""

import contextlib

from PySide import QtCore

PATIENCE = 3000  # milliseconds to wait for a killed process


def new():
    """Returns a process that reads nothing, ready to start; release it with `end`."""
    process = QtCore.QProcess(QtCore.QCoreApplication.instance())
    process.setStandardInputFile(QtCore.QProcess.nullDevice())
    return process


def end(process):
    """Releases a process, and kills it if it runs. Returns False if it still runs, for example because it waits for a
    disk."""
    for signal in (process.finished, process.readyReadStandardError):
        with contextlib.suppress(RuntimeError):  # raised for a signal without connections
            signal.disconnect()
    process.kill()
    process.waitForFinished(PATIENCE)
    process.deleteLater()
    return process.state() == QtCore.QProcess.NotRunning
