# AirDOS on LCM in a container: builds the Debian packages, installs them in a clean system, runs the demo there as a user.
#
#   docker build -t airdos .
#   docker run --rm -v "$PWD/results:/results" airdos          the demo
#   docker run --rm -v DATA:/data:ro -v "$PWD/results:/results" airdos airdos-replay /data --run-dir /results/run
#
# The results' folder must be writable for user 1000, or say --user "$(id -u):$(id -g)".

FROM debian:12 AS tools
# First what seldom changes: the packages.
COPY CMakeLists.txt /src/
COPY launch_scripts/common.sh launch_scripts/setup.sh /src/launch_scripts/
RUN apt-get update \
    && apt-get install -y --no-install-recommends ca-certificates git \
    && /src/launch_scripts/setup.sh --packages-only

# What a developer needs besides; .devcontainer uses it.
FROM tools AS development
RUN /src/launch_scripts/setup.sh --packages-only --development \
    && apt-get install -y --no-install-recommends ccache gdb less openssh-client sudo \
    && useradd --create-home --shell /bin/bash --uid 1000 developer \
    && echo 'developer ALL=(ALL) NOPASSWD:ALL' > /etc/sudoers.d/developer \
    && rm -rf /src
USER developer

FROM tools AS build
COPY . /src
RUN /src/launch_scripts/package.sh

FROM debian:12 AS run
COPY --from=build /src/build/packages/*.deb /tmp/packages/
RUN apt-get update \
    && apt-get install -y --no-install-recommends /tmp/packages/airdos_*.deb \
    && rm -rf /tmp/packages /var/lib/apt/lists/* \
    && useradd --create-home --uid 1000 airdos \
    && install -d -o airdos /results
USER airdos
WORKDIR /results
VOLUME /results
CMD ["bash", "-ec", "mkdir -p demo; airdos-replay /usr/share/airdos/logs/road_crossing06.lcm --out demo/output.lcm --run-dir demo --force; airdos-evaluate trajectory --estimate demo/trajectory.tum --ground-truth demo/ground_truth.tum --json demo/evaluation.json --plot demo/trajectory.png --force; airdos-map plot demo/map.airdos --out demo/map.png --force"]
