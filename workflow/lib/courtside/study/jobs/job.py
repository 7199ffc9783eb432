"""A job of the study: the checked configuration and the wildcards of the files that it makes."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any, TypeVar

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Device, FixedCamera, Model, Session, Study, Take
from courtside.study.errors import InputError, nearest

Named = TypeVar("Named")


@dataclass(frozen=True)
class Job:
    """What the files of a job belong to; `job["camera"]` is a wildcard."""

    study: Study
    wildcards: Mapping[str, str]

    def __getitem__(self, name: str) -> str:
        return self.wildcards[name]

    @property
    def session(self) -> Session:
        """The session."""
        return self.study.sessions[self["session"]]

    @property
    def take(self) -> Take:
        """Its take; an error where somebody in it has not agreed to be measured."""
        session, name = self.session, self["take"]
        if name in session.withheld:
            who = ", ".join(consent.refusing(session, session.withheld[name], "analysis"))
            raise InputError(
                f"{session.file}: expected analysis in the consent of {who}, "
                f"found none: nothing is made of take {name}; ask for files of other takes"
            )
        return self.named(session.takes, "take")

    @property
    def camera(self) -> FixedCamera:
        """Its fixed camera."""
        return self.named(self.session.cameras, "camera")

    @property
    def device(self) -> Device:
        """Its device; of a file of all takes, the last take's of this name."""
        takes = [self.take] if "take" in self.wildcards else self.session.takes.values()
        there = {name: device for take in takes for name, device in take.devices.items()}
        return self.named(there, "device")

    def named(self, known: Mapping[str, Named], what: str) -> Named:
        """Return the record of a wildcard; an error where a file of another one is asked for."""
        if self[what] not in known:
            there = ", ".join(known) or "none"
            advice = nearest(self[what], list(known), "ask for files of one that is there")
            raise InputError(
                f"{self.session.file}: expected a {what} of {there}, found {self[what]!r}; {advice}"
            )
        return known[self[what]]

    @property
    def virtual(self) -> dict[str, Any]:
        """What its session is simulated from; empty of a real one."""
        return self.session.virtual or {}

    @property
    def model(self) -> Model:
        """Its pose network."""
        return self.study.models[self["model"]]

    def step(self, name: str) -> dict[str, Any]:
        """Return the parameters of a step, with the session's overrides."""
        return self.session.parameters[name]

    def some(self, step: str, keys: Iterable[str]) -> dict[str, Any]:
        """Return some parameters of a step."""
        return {key: self.step(step)[key] for key in keys}

    def fill(self, pattern: str, **more: Any) -> str:
        """Fill a pattern of `paths` with the wildcards, and with more or other ones."""
        return pattern.format(**{**self.wildcards, **more})

    def of_each(self, pattern: str, **choice: Iterable[str]) -> list[str]:
        """Fill a pattern with the wildcards, and with each of several values of other ones."""
        return paths.each(pattern, **{**self.wildcards, **choice})

    def true_file(self, pattern: str) -> str | list:
        """Return a file that rests on the truth, nothing of a real session."""
        return self.fill(pattern) if self.session.virtual else []

    def court_file(self) -> Path | list:
        """Return the court of its session, nothing without a court."""
        return self.study.court_file(self.session) or []

    def skeleton_file(self) -> Path:
        """Return the skeleton of its pose network."""
        return self.study.skeleton_file(self["model"])

    def stages(self) -> tuple[str, ...]:
        """Return the stages of its network's skeletons; the last is the best."""
        return self.study.stages(self["model"])

    def judged_stages(self) -> list[tuple[str, str]]:
        """Return (stage, fusion) of the skeletons of a take that are compared with truth.

        Every stage and fusion; the model's joints of the fusions that are exported.
        """
        stages = self.stages()
        more = self.study.written_stages(self["model"])[len(stages) :]
        exported = self.session.fusions_of(self.take)
        return [*product(stages, self.every_fusion()), *product(more, exported)]

    def every_fusion(self) -> list[str]:
        """Return all ways to fuse views that a take has, each once, the exported ones first."""
        session, take = self.session, self.take
        both = session.fusions_of(take) + session.fusions_of(take, "compared_fusions")
        return list(dict.fromkeys(both))

    def demand(self, word: str) -> None:
        """Stop, with one line, where persons of its files have not agreed to something."""
        who = consent.refusing(self.session, self.take, word)
        who = tuple(name for name in who if name == self.wildcards.get("person", name))
        if who:
            raise InputError(
                f"{self.session.file}: expected {word} in the consent of {', '.join(who)} for this "
                f"file of take {self.take.name}, found none; ask them, or do not ask for the file"
            )
