"""The kind of a device, not the ending of its file, chooses the reader."""

import pytest

from courtside.devices import open_motion
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError

MOCOPI = skeleton.read("config/skeletons/mocopi27.yaml")


@pytest.mark.parametrize(("kind", "reader"), [("inertial", "HIERARCHY"), ("nuitrack", "Nuitrack")])
def test_each_kind_has_its_reader(tmp_path, kind, reader):
    path = tmp_path / "a.xml"
    path.write_text("<mvnx/>")
    with pytest.raises(InputError, match=reader):
        open_motion.read(path, MOCOPI, device="suit", kind=kind)


def test_a_kind_without_a_reader_is_read_by_none(tmp_path):
    with pytest.raises(ValueError, match="xsens: expected a kind with a reader in devices/open_mo"):
        open_motion.read(tmp_path / "a.mvnx", MOCOPI, device="suit", kind="xsens")
