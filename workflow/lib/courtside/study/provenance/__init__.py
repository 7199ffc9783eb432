"""Where a result comes from: its record, verification, comparison, environment, bill of materials."""
