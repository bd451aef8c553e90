"""Processes of Qt that may outlive the object that started them.
Qt's main loop frees a process when nothing refers to it any more, and with it the objects that the process's
connections hold. If one of these were the parent of the process, it would free the process a second time.
So the application is the parent of all processes, and `end` removes the connections of a process."""

import contextlib

from PySide import QtCore

PATIENCE = 3000  # milliseconds to wait for a killed process


def new():
    """Returns a process without standard input, ready to start. Release it with `end`."""
    process = QtCore.QProcess(QtCore.QCoreApplication.instance())
    process.setStandardInputFile(QtCore.QProcess.nullDevice())
    return process


def end(process):
    """Releases a process, and kills it if it runs. Returns False if it still runs, for example because it
    waits for a disk."""
    for signal in (process.finished, process.readyReadStandardError):
        with contextlib.suppress(RuntimeError):  # raised for a signal without connections
            signal.disconnect()
    process.kill()
    process.waitForFinished(PATIENCE)
    process.deleteLater()
    return process.state() == QtCore.QProcess.NotRunning
