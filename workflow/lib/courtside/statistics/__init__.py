"""Statistics of measures: agreement of two ways, change over sessions, dependent samples."""
