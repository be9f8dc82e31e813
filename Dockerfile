# The whole pipeline in a container:
#
#   docker build -t roughgas .
#   docker run --name figures roughgas && docker cp figures:/roughgas/figures .
FROM python:3.11-slim

# HOME is anybody's, so that --user may be anybody
RUN useradd --no-create-home --home-dir /home/roughgas roughgas \
    && install --directory --mode 1777 /home/roughgas \
    && install --directory --owner roughgas /roughgas
ENV HOME=/home/roughgas USER=roughgas PATH=/opt/roughgas/bin:$PATH
WORKDIR /roughgas

# what is pinned first: it changes less often than the project
COPY requirements.lock requirements/article.lock ./
RUN python -m venv /opt/roughgas \
    && /opt/roughgas/bin/python -m pip install --no-cache-dir --require-hashes \
        --requirement requirements.lock --requirement article.lock

COPY --chown=roughgas CHANGELOG.md CITATION.cff LICENSE Makefile README.md Snakefile config.yaml pyproject.toml ./
COPY --chown=roughgas article article
COPY --chown=roughgas config config
COPY --chown=roughgas docs docs
COPY --chown=roughgas profiles profiles
COPY --chown=roughgas rules rules
COPY --chown=roughgas src src
COPY --chown=roughgas studies studies
COPY --chown=roughgas tests tests
COPY --chown=roughgas workflow workflow
RUN /opt/roughgas/bin/python -m pip install --no-cache-dir --no-deps --no-build-isolation --editable .

USER roughgas
CMD ["snakemake", "-j2", "figures"]
