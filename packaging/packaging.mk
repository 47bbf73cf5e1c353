# Packages of distributions, included by the Makefile at the top of the sources, from where all paths start.

.PHONY: man deb

#: man                   manual pages from bindings/api.json, in $(BUILD)/man
man:
	@python3 tools/man.py $(VERSION) $(BUILD)/man

#: deb                   Debian's packages by dpkg-buildpackage, from what git has, in $(BUILD)/deb; lintian must be content
deb:
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL -u BUILD bash packaging/deb.sh $(abspath $(BUILD))/deb

.PHONY: check-gallery
#: check-gallery         every program of the gallery on few particles: docs/gallery.md. PYTHON: one that has the package mpm
check-gallery: all
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL bash gallery/check.sh
