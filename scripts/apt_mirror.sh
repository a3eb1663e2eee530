# Where this machine gets Debian from, for scripts that need more of it than is configured. Sourced, by setup.sh and
# portable.sh; expects fail().
# shellcheck shell=bash

# Prints the Signed-By field of an apt source, as lines of a deb822 stanza; nothing where it has none.
# ENTRY is what apt calls it: FILE:STANZA for .sources, FILE:LINE for .list.
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

# Prints the configured binary indices, a line each: RELEASE|COMPONENT|ORIGIN|URI|ENTRY.
apt_indices() {
    # shellcheck disable=SC2016 # apt expands these, not the shell
    apt-get indextargets --format '$(RELEASE)|$(COMPONENT)|$(ORIGIN)|$(REPO_URI)|$(SOURCESENTRY)' 'Created-By: Packages'
}

# debian_stanza TYPE SUITE: a deb822 stanza for a suite of Debian's main component, from the mirror and under the key that
# this machine uses for Debian 12 itself. Status 1 where it uses none.
debian_stanza() {
    local release component origin uri entry
    while IFS='|' read -r release component origin uri entry; do
        if [[ $release == bookworm && $component == main && $origin == Debian ]]; then
            printf 'Types: %s\nURIs: %s\nSuites: %s\nComponents: main\n' "$1" "$uri" "$2"
            signed_by "$entry"
            return
        fi
    done < <(apt_indices)
    return 1
}
