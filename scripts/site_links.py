"""Hooks for mkdocs. It does not treat link targets without an extension as files: a link to a folder of the sources goes to a
page that lists its contents, and a link that leads nowhere causes a warning, as other links do. It shows a list as text if
no blank line stands before it, as other readers of Markdown do not: this causes a warning, too."""
import logging
import re
from pathlib import Path

FENCE = re.compile(r"^ *```.*?^ *```$", re.M | re.S)
LIST_IN_TEXT = re.compile(r"^(?![-*] |[#|>\s]|\d+\. ).*\n(?:[-*]|\d+\.) .*", re.M)
LINK = re.compile(r"(?<=\]\()([^)#:\s]+?)/?(?=\))")

log = logging.getLogger("mkdocs.plugins.site_links")


def folder_at(page, target):
    """Returns the folder that a page links to, or None if the target is no folder."""
    path = Path(page).parent / target
    return path if path.is_dir() else None


def on_pre_build(config):
    source = Path(config["docs_dir"])
    linked = {folder.resolve() for page in source.rglob("*.md") for target in LINK.findall(page.read_text())
              if (folder := folder_at(page, target))}
    for folder in linked:
        if (folder / "README.md").exists():
            continue
        names = sorted(f"{entry.name}{'/README.md' * entry.is_dir()}" for entry in folder.iterdir()
                       if entry.is_file() or entry.resolve() in linked)
        (folder / "README.md").write_text(f"# {folder.relative_to(source.resolve())}\n\n"
                                          + "".join(f"- [{name}]({name})\n" for name in names))


def on_page_markdown(markdown, page, **_):
    here = page.file.abs_src_path

    def corrected(link):
        if folder_at(here, link[1]):
            return f"{link[1]}/README.md"
        if "." not in Path(link[1]).name and not (Path(here).parent / link[1]).exists():
            log.warning("Documentation file '%s' contains a link to '%s', which is not there", page.file.src_path, link[1])
        return link[0]

    for text in LIST_IN_TEXT.findall(FENCE.sub("", markdown)):
        log.warning("Documentation file '%s' has a list without a blank line before it: %s", page.file.src_path, text)
    return LINK.sub(corrected, markdown)
