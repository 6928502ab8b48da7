# shellcheck shell=bash
# What the scripts of this folder share; sourced by them.

fail() { echo "error: $*" >&2; exit 1; }

# needs TOOL HOW-TO-GET-IT
needs() { command -v "$1" >/dev/null || fail "$1 is missing: $2"; }

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
needs cargo "install a Rust toolchain"
version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -n 1)
machine=$(uname -m)
target=${CARGO_TARGET_DIR:-target}
packages=${PACKAGES:-$target/packages}
# Every file of a package has the time of the commit, so that the same commit makes the same package.
if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then
    SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null) || fail "there is no git history: set SOURCE_DATE_EPOCH"
fi
export SOURCE_DATE_EPOCH

# binary [FILE [ENDING]]: sets `binary` to the one that is named, or to one that is built, into which no folder of this
# machine gets.
binary() {
    binary=${1:-}
    if [ -z "$binary" ]; then
        # where rust-lld links, equal functions are kept once and relocations are packed, which glibc reads from 2.36 on;
        # elsewhere the linker may not know how
        local small=()
        [ "$(uname -sm)" != "Linux x86_64" ] ||
            small=(-C link-arg=-Wl,--icf=all -C link-arg=-Wl,-z,pack-relative-relocs)
        RUSTFLAGS="--remap-path-prefix=$root=. --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo" \
            cargo rustc --locked --profile dist --bin interwell -- -C strip=symbols ${small[@]+"${small[@]}"}
        binary=$target/dist/interwell${2:-}
    fi
    [ -x "$binary" ] || fail "$binary is no program"
}

# stage BINARY FOLDER: what is installed, below FOLDER as below /usr or ~/.local.
stage() {
    local program=$1 folder=$2 share=$2/share word shell
    needs gzip "install gzip"
    cargo cyclonedx --version >/dev/null 2>&1 || fail "cargo-cyclonedx is missing: cargo install --locked cargo-cyclonedx"

    install -D -m 755 "$program" "$folder/bin/interwell"
    mkdir -p "$share/man/man1"
    "$program" manual >"$share/man/man1/interwell.1"
    for word in $(sed -n 's/^\.SH SUBCOMMANDS//;s/^interwell\\-\([a-z]*\)(1)$/\1/p' "$share/man/man1/interwell.1"); do
        "$program" manual "$word" >"$share/man/man1/interwell-$word.1"
    done
    gzip -9n "$share"/man/man1/*.1
    completion() { mkdir -p "$share/$2" && "$program" completions "$1" >"$share/$2/$3"; }
    completion bash bash-completion/completions interwell
    completion zsh zsh/vendor-completions _interwell
    completion fish fish/vendor_completions.d interwell.fish

    install -D -m 644 packaging/interwell.desktop "$share/applications/interwell.desktop"
    install -D -m 644 packaging/interwell.metainfo.xml "$share/metainfo/alt.interwell.interwell.metainfo.xml"
    install -D -m 644 packaging/interwell.xml "$share/mime/packages/interwell.xml"
    packaging/icons "$share/icons"

    scenes "$program" "$share/interwell"
    documents "$share/doc/interwell"
    sbom "$share/doc/interwell/interwell.cdx.json"

    find "$folder" -type d -exec chmod 755 {} +
    find "$folder" -type f -not -path '*/bin/*' -exec chmod 644 {} +
    find "$folder" -exec touch --no-dereference --date "@$SOURCE_DATE_EPOCH" {} +
}

# scenes BINARY FOLDER: the presets, with the files that they read, and the lessons.
scenes() {
    mkdir -p "$2/presets" "$2/lessons"
    "$1" --headless presets --quiet --write "$2/presets" >/dev/null
    cp kernel/lessons/*.ron "$2/lessons"
}

# documents FOLDER: they lie beside each other as in the source, so that their links lead somewhere.
documents() {
    mkdir -p "$1/docs" "$1/assets" "$1/python"
    cp README.md CHANGELOG.md CONTRIBUTING.md SECURITY.md CITATION.cff LICENSE-APACHE LICENSE-MIT "$1"
    cp python/README.md "$1/python"
    cp docs/*.md "$1/docs"
    cp assets/*.png "$1/assets"
    licences interwell "$1/LICENCES-OF-PARTS.txt"
}

# licences PACKAGE FILE: those of the fonts, and of all crates that are linked into the package.
licences() {
    { cat studies/assets/fonts/LICENSE-*.txt; echo; "${python:-python3}" packaging/licences "$1"; } >"$2"
}

# papers BINARY FOLDER: scenes and documents beside a program that is not installed.
papers() {
    scenes "$1" "$2"
    documents "$2"
}

# sbom FILE: the crates that are linked, as CycloneDX.
sbom() {
    cargo cyclonedx --quiet --format json --spec-version 1.5 --no-build-deps --override-filename interwell.sbom
    sed "s#file://$root#file:///interwell#g" interwell.sbom.json >"$1"
    rm -f interwell.sbom.json ./*/interwell.sbom.json
}

# checksums: SHA256SUMS of what lies in the folder of packages.
checksums() {
    local sum="sha256sum"
    command -v sha256sum >/dev/null || sum="shasum --algorithm 256"
    (cd "$packages" && rm -f SHA256SUMS && LC_ALL=C && export LC_ALL && $sum -- * >SHA256SUMS.new && mv SHA256SUMS.new SHA256SUMS)
}
