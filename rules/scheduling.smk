# How Snakemake starts jobs.


def start_jobs_at_once(workflow):
    """Take away the limit of jobs per second, whose timers take a quarter of all CPU in a long run.

    Each pass of the scheduler starts a timer that starts another pass, and these chains never end
    (Snakemake's issue 2354, its pull request 3744); no setting turns the limit off. It is kept where
    jobs go to a cluster, for which it was made.
    """
    if workflow.local_exec:
        workflow.scheduler.job_rate_limiter = None
