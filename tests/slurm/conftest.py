"""A cluster shared by all tests of this folder."""

import os

import pytest
from cluster import Cluster
from on_cluster import SNAKEMAKE


@pytest.fixture(scope="session")
def cluster():
    assert os.access(SNAKEMAKE, os.X_OK), "make .venv-slurm/ready"
    cluster = Cluster()
    try:
        cluster.start()
        yield cluster
    finally:
        cluster.stop()
