"""The truth of simulated sessions and takes: read by evaluation only."""
