"""The tests of a file stay in one of the processes (`-n 2` of pyproject.toml), all that share a study too."""

from pathlib import PurePosixPath

from xdist.scheduler import LoadFileScheduling

ONE_STUDY = {"smoke", "faults", "slurm"}  # folders


class ByStudy(LoadFileScheduling):
    """Gives a process the tests of one file, or of all folders that look at one study, which is made once."""

    def _split_scope(self, nodeid):
        file = PurePosixPath(nodeid.partition("::")[0])
        return "study" if ONE_STUDY.intersection(file.parts) else str(file)


def pytest_xdist_make_scheduler(config, log):
    config.option.loadscopereorder = False  # the study is collected first, and takes longest
    return ByStudy(config, log)
