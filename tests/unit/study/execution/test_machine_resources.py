"""What a full disk, a closed folder and too little memory are told as."""

import errno
import os
import subprocess
import zlib

import cv2
import numpy as np
import pytest

from courtside.study.errors import InputError
from courtside.study.execution import machine_resources

ROOT_OR_WINDOWS = os.name == "nt" or os.geteuid() == 0


def test_a_folder_with_room_passes(tmp_path):
    assert machine_resources.check(tmp_path) is None


def test_too_little_room_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(machine_resources, "LEAST_FREE_MB", 10**12)
    with pytest.raises(InputError, match=r"MB free on its disk, found [\d.]+ MB; free some room"):
        machine_resources.check(tmp_path)


@pytest.mark.skipif(ROOT_OR_WINDOWS, reason="root may write to every folder; Windows has no mode")
def test_a_closed_folder_is_told(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(InputError, match="found it read-only"):
        machine_resources.check(tmp_path)


def test_a_folder_that_cannot_be_written_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(machine_resources.os, "access", lambda path, mode: not mode & os.W_OK)
    with pytest.raises(InputError, match="found it read-only"):
        machine_resources.check(tmp_path)


def test_a_folder_of_windows_is_tried(tmp_path, monkeypatch):
    monkeypatch.setattr(machine_resources.files, "WINDOWS", True)
    assert machine_resources.check(tmp_path) is None
    assert list(tmp_path.iterdir()) == []

    def refuse(path, exist_ok):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))

    monkeypatch.setattr(machine_resources.Path, "touch", refuse)
    with pytest.raises(InputError, match="found it read-only"):
        machine_resources.check(tmp_path)


def raised(action):
    with pytest.raises((OSError, MemoryError)) as caught:
        action()
    return caught.value


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such device")
def test_a_real_full_disk_is_one_line():
    with open("/dev/full", "w") as stream:  # noqa: PTH123 -- the device of this name is full
        stream.write("x")
        line = machine_resources.in_words(raised(stream.flush))
        with pytest.raises(OSError):
            stream.close()
    assert line.startswith("a result: expected room on the disk, found: No space left on device")
    assert "same command again" in line and "\n" not in line


@pytest.mark.parametrize("number", [errno.EROFS, errno.EACCES])
def test_a_file_that_may_not_be_used_is_named(number):
    line = machine_resources.in_words(OSError(number, os.strerror(number), "results/a.npz"))
    assert line.startswith(
        f"results/a.npz: expected the right to use it, found: {os.strerror(number)}"
    )


def test_a_real_lack_of_memory_is_one_line():
    line = machine_resources.in_words(raised(lambda: np.ones(1 << 45)))
    assert "Unable to allocate" in line and "--cores 1" in line and "\n" not in line


def test_the_fault_behind_another_is_told():
    error = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    try:
        try:
            raise error
        finally:
            zlib.decompress(b"no stream")
    except zlib.error as second:
        assert machine_resources.in_words(second).startswith("a result: expected room on the disk")


def test_a_lack_of_memory_in_opencv_is_one_line():
    error = cv2.error(
        "OpenCV(5.0.0) alloc.cpp:73:\n error: (-4:Insufficient memory) Failed to allocate"
    )
    line = machine_resources.in_words(error)
    assert line.startswith("expected enough memory, found none left (OpenCV") and "\n" not in line


@pytest.mark.parametrize(
    "error",
    [FileNotFoundError(errno.ENOENT, "gone", "a"), ValueError("x"), subprocess.SubprocessError()],
)
def test_other_faults_keep_their_words(error):
    assert machine_resources.in_words(error) is None
