"""The study and its sessions: YAML files, checked as a whole, every fault in one line."""
