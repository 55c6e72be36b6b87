# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# Adds a distribution's backports from the mirror that apt is configured with. Sourced by
# scripts/setup.sh, with packages.sh.

# The archive that the distribution itself is taken from, as "address suite": the entry of apt's own
# configuration whose release file says Debian and carries the code name $1. Third parties use the
# same code name but not the same label.
distribution_archive() {
    local codename=$1
    # The dollars are apt's, not the shell's.
    # shellcheck disable=SC2016
    apt-get indextargets --format '$(LABEL)|$(CODENAME)|$(COMPONENT)|$(REPO_URI)|$(RELEASE)' \
        'Created-By: Packages' |
        awk -F '|' -v codename="$codename" '
            $1 == "Debian" && $2 == codename && $3 == "main" && !found {
                sub(/\/+$/, "", $4)
                print $4 " " $5
                found = 1
            }'
}

# Rewrites the one-line entry of file $1 that names archive $2 and suite $3 to suite $4, main; the
# options in its brackets (signed-by, trusted, arch) are preserved. Prints nothing if there is none.
rewrite_line() {
    awk -v uri="$2" -v suite="$3" -v wanted="$4" '
        { sub(/#.*/, "") }
        match($0, /^[ \t]*deb[ \t]+(\[[^]]*\][ \t]*)?/) {
            start = substr($0, 1, RLENGTH)
            split(substr($0, RLENGTH + 1), word, /[ \t]+/)
            address = word[1]
            sub(/\/+$/, "", address)
            if (address == uri && word[2] == suite) {
                print start word[1] " " wanted " main"
                exit
            }
        }' "$1"
}

# The same for a file of paragraphs (deb822); an embedded key is kept as it is.
rewrite_paragraph() {
    sed '/^#/d' "$1" | awk -v uri="$2" -v suite="$3" -v wanted="$4" '
        function names(list, name,    n, i, words) {
            n = split(list, words, /[ \t]+/)
            for (i = 1; i <= n; ++i) {
                sub(/\/+$/, "", words[i])
                if (words[i] == name)
                    return 1
            }
            return 0
        }
        BEGIN { RS = ""; FS = "\n" }
        {
            split("", value)
            kept = ""
            for (i = 1; i <= NF; ++i) {
                text = $i
                if ($i !~ /^[ \t]/) {
                    field = tolower($i)
                    sub(/[ \t]*:.*/, "", field)
                    sub(/^[^:]*:/, "", text)
                }
                value[field] = value[field] " " text
                if (field !~ /^(types|suites|components|enabled)$/)
                    kept = kept "\n" $i
            }
            if (names(value["types"], "deb") && names(value["uris"], uri) && !found &&
                names(value["suites"], suite) && tolower(value["enabled"]) !~ /no|off|false|0/) {
                print "Types: deb\nSuites: " wanted "\nComponents: main" kept
                found = 1
            }
        }'
}

# Prints the entry of apt's configuration in folder $1 for archive $2 and suite $3, rewritten to
# suite $4, and before it, on a line of its own, the ending that a file with it must have.
find_entry() {
    local file entry
    for file in "$1"/sources.list "$1"/sources.list.d/*.list "$1"/sources.list.d/*.sources; do
        [[ -r $file ]] || continue
        case $file in
            *.sources) entry=$(rewrite_paragraph "$file" "$2" "$3" "$4") ;;
            *) entry=$(rewrite_line "$file" "$2" "$3" "$4") ;;
        esac
        if [[ -n $entry ]]; then
            printf '%s\n%s\n' "${file##*.}" "$entry"
            return
        fi
    done
}

# Adds the backports of code name $1 to apt, from the mirror that this machine already uses; takes
# them away again when the mirror has no package $2 there.
add_backports() {
    local codename=$1 package=$2 uri='' suite='' entry='' added
    read -r uri suite < <(distribution_archive "$codename") || true
    [[ -z $uri ]] || entry=$(find_entry /etc/apt "$uri" "$suite" "$codename-backports")
    if [[ -z $entry ]]; then
        say "apt's configuration names no Debian mirror for $codename, so backports cannot be added"
        return
    fi
    added=/etc/apt/sources.list.d/shutter-backports.${entry%%$'\n'*}
    say "adding $codename-backports of the mirror $uri to apt, in $added"
    printf '%s\n' "${entry#*$'\n'}" | as_root tee "$added" >/dev/null
    update_apt_lists
    if [[ -z $(backports_version "$codename" "$package") ]]; then
        as_root rm -f "$added"
        say "the mirror $uri has no $package in $codename-backports; its entry is removed again"
    fi
}

# The version of package $2 in the backports of code name $1 that apt knows of, or nothing.
backports_version() {
    apt-cache madison "$2" |
        awk -F ' *[|] *' -v suite=" $1-backports/" \
            'index($3, suite) && !found { print $2; found = 1 }'
}
