"""The study and its sessions: YAML files, checked as a whole, every fault in one line.

configuration: `load` checks everything and returns the `Study`
sessions: the records `Study`, `Session`, `Take`, `FixedCamera`, `Device`, `Subject`, `Model`
session_files: `session` and `variations` build sessions from checked files
session_faults, take_faults, sighting_faults, model_faults, named_faults: what schemas cannot check
consent: `by_consent`, `refusing` and `left_out` say what persons have not agreed to
plans: `read` a session that is only planned
schemas: `read` a file that a JSON schema describes, `faults` in words
yaml_files: `read` YAML without duplicate keys; `file_of`, in which a value stands
"""
