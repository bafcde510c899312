# lgabench in an image:  docker build -t lgabench .
# A run of it:           docker run --rm -v "$PWD/runs:/data/runs" lgabench run q1 --preset smoke
FROM debian:12
COPY . /src
RUN cd /src && ./install /opt/lgabench && rm -rf /src /var/lib/apt/lists/*
ENV PATH=/opt/lgabench/bin:$PATH LGABENCH_CACHE=/data/runs/.cache
WORKDIR /data
ENTRYPOINT ["lgabench"]
CMD ["--help"]
