"""The farm: the project's long checks as a list of jobs, which runs on this machine or under Slurm."""
