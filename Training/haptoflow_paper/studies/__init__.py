"""Studies beside the table of accuracy and time: materials of seconds, places felt twice, estimates of velocity."""
