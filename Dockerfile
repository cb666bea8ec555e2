# SPDX-License-Identifier: BSD-3-Clause
# docker build -t repel . && docker run --rm -it repel [--seconds 20] [--fast] [SCENE]
FROM debian:bookworm-slim
COPY . /repel
RUN /repel/run --seconds 1 --fast
ENTRYPOINT ["/repel/run"]
