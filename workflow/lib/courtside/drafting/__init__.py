"""A session's YAML file drafted from a folder of recordings.

survey: what every file of a folder is
guess: cameras, walks and takes, from the names of files
draft: the session's file, its study, and advice
"""
