#!/usr/bin/env bash
# The model of the frame protocol with small bounds, and its mutants, which must fail. No process of
# Jolon takes part. `make model` searches further.
cd "$(dirname "$0")/../model" || exit 1
if ! command -v spin >/dev/null; then
    echo "ok 1 - model # skip the package spin is not installed"
    exit 0
fi
if [ -n "${JOLON_SANITIZER:-}" ]; then
    echo "ok 1 - model # skip it runs nothing that is sanitized"
    exit 0
fi
exec ./run short
