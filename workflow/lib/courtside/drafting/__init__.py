"""Drafting of a session's YAML file from a folder of recordings.

survey: `survey`: what every file of a folder is; `written`: its path as a session names it
guess: `guess`: cameras, walks and takes, from the names of files
recordings: `Recording`, `Guess`, `called`, `uncounted`, `is_called_walk`, `lengths_fit`
camera_words: `of`, `told`, `without_trials`: words that name cameras
pairing: `group`, `numbered`: recordings that are one take
names: `words_of`, `name`, `distinct`, `alike`: words of any script; `device_names`: of recorders
additions: `to_paste`: takes that a session's file has not yet
draft: `text`, `write`, `write_study`: the session's file and its study
advice: `to_check`, `doubts`: what a user should check after that
"""
