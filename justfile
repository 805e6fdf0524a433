# What a contributor needs, by name: `just --list`. A justfile, because cargo's aliases can neither set a variable nor run
# the scripts of tests/. Every recipe is one plain command, so nobody needs `just`: CONTRIBUTING.md lists them.

[private]
default:
    @just --list

# Form, lints, and whether all targets compile; runs no test
check:
    cargo fmt --all --check
    cargo clippy --all-targets --locked -- -D warnings

# Unit tests without the slow ones, and one suite, after every change
quick *suite:
    tests/quick {{suite}}

# All tests, or what the arguments select
test *arguments:
    tests/run {{arguments}}

# Everything that must hold before a change lands
all:
    .ci/run

# The complete workflow on a built-in example
demo:
    cargo run --release --locked -- demo

# The documentation of the library, and the transcripts and links of docs/
docs:
    RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --locked
    tests/run --test docs documentation

# One benchmark: issue, register, verify_process or monte_carlo
bench name *arguments:
    cargo bench --locked --bench {{name}} -- {{arguments}}

# Sign the example passports again after a change of the format, then read the difference
update-examples:
    UPDATE_EXAMPLES=1 cargo test --locked --test docs examples
    git diff --stat

# Write the JSON Schemas, completions and manual pages again, then read the difference
update-generated:
    UPDATE_GENERATED=1 cargo test --locked --features generate --test generated
    git diff --stat

# Accept new output of the command line, then read the difference
update-transcripts:
    TRANSCRIPTS=write cargo test --locked --test cli transcripts
    git diff --stat -- tests/cmd
