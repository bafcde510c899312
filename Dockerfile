# lgabench in an image:  docker build --build-arg COMMIT="$(git rev-parse --short=12 HEAD)" -t lgabench .
# A run of it:           docker run --rm --user "$(id -u):$(id -g)" -v "$PWD/runs:/data/runs" lgabench run clutter --preset smoke
# With compilers, for plugins of your own: docker build --target build -t lgabench-build .
FROM debian:12 AS build
COPY . /src
WORKDIR /src
ARG COMMIT=unknown
RUN LGABENCH_COMMIT="$COMMIT" ./install /opt/lgabench

FROM debian:12
# Python for methods written in it; the libraries that programs and plugins load.
RUN apt-get update -qq && apt-get install -y -qq --no-install-recommends ca-certificates python3-numpy libboost-filesystem1.74.0 libbullet3.24 libcpp-httplib0.11 libcurl4 libembree3-3 libfmt9 libgif7 libhdf5-103-1 libopenblas0-pthread libopencv-core406 libopencv-imgproc406 libpng16-16 libseccomp2 libssl3 libtorch1.13 libutf8proc2 >/dev/null && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/lgabench /opt/lgabench
ENV PATH=/opt/lgabench/bin:$PATH LGABENCH_CACHE=/data/runs/.cache
RUN useradd --uid 1000 lgabench && mkdir -p /data/runs && chown -R lgabench /data
WORKDIR /data
USER lgabench
ENTRYPOINT ["lgabench"]
CMD ["--help"]
