# lgabench in an image:  docker build -t lgabench .
# A run of it:           docker run --rm -v "$PWD/runs:/work/runs" lgabench run q1 --preset smoke
FROM debian:12
COPY . /src
RUN cd /src && ./install /opt/lgabench && rm -rf /src /var/lib/apt/lists/*
ENV PATH=/opt/lgabench/bin:$PATH LGABENCH_CACHE=/work/runs/.cache
WORKDIR /work
ENTRYPOINT ["lgabench"]
CMD ["--help"]
