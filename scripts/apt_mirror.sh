# Finds where this machine gets its distribution from, for scripts that need more of it than is configured. setup.sh,
# portable.sh and fetch_basisu.sh source this file. It expects fail().
# shellcheck shell=bash

# Prints the Signed-By field of an apt source as lines of a deb822 stanza, or nothing if it has none. ENTRY is
# apt's name for the source: FILE:STANZA for .sources, FILE:LINE for .list.
signed_by() {
    local file=${1%:*} place=${1##*:}
    if [[ $file == *.sources ]]; then
        # An embedded key continues on indented lines.
        awk -v stanza="$place" '
            /^[[:space:]]*$/ { if (inside) { inside = 0 } field = 0; next }
            /^#/ { next }
            !inside { inside = 1; count++ }
            /^[^[:space:]]/ { field = tolower($0) ~ /^signed-by:/ }
            count == stanza && field { print }
        ' "$file"
    else
        sed -n "${place}s/.*[[ ]signed-by=\([^] ]*\).*/Signed-By: \1/p" "$file"
    fi
}

# Prints the configured binary indices, one in each line: RELEASE|COMPONENT|ORIGIN|URI|ENTRY.
apt_indices() {
    # shellcheck disable=SC2016 # apt expands these, not the shell
    apt-get indextargets --format '$(RELEASE)|$(COMPONENT)|$(ORIGIN)|$(REPO_URI)|$(SOURCESENTRY)' 'Created-By: Packages'
}

# mirror_stanza TYPE SUITE [COMPONENT]: prints a deb822 stanza for a suite of Debian or Ubuntu (component main
# by default). It uses the mirror and the key that this machine uses for its own release of it. The status is
# 1 if the machine uses none.
mirror_stanza() {
    local release component origin uri entry own
    # shellcheck source=/dev/null
    own=$(. /etc/os-release && printf '%s|main|%s|' "${VERSION_CODENAME:-}" "${ID:-}")
    while IFS='|' read -r release component origin uri entry; do
        if [[ "$release|$component|${origin,,}|" == "$own" ]]; then
            printf 'Types: %s\nURIs: %s\nSuites: %s\nComponents: %s\n' "$1" "$uri" "$2" "${3:-main}"
            signed_by "$entry"
            return
        fi
    done < <(apt_indices)
    return 1
}

# private_apt FOLDER: sets the array private_apt_options. With it, apt-get reads only the sources in
# FOLDER/parts, and keeps its lists and caches below FOLDER; this machine's own do not change. Everything that
# apt fetches must be signed.
private_apt() {
    mkdir -p "$1/parts" "$1/lists/partial" "$1/cache/archives/partial"
    # shellcheck disable=SC2034 # for the caller
    private_apt_options=(-q -o "Dir::Etc::SourceList=/dev/null" -o "Dir::Etc::SourceParts=$1/parts"
        -o "Dir::State::Lists=$1/lists" -o "Dir::Cache=$1/cache" -o "APT::Sandbox::User=root"
        -o "Acquire::AllowInsecureRepositories=false" -o "APT::Get::AllowUnauthenticated=false"
        -o "Acquire::Retries=1" -o "Acquire::http::Timeout=30" -o "Acquire::https::Timeout=30")
}
