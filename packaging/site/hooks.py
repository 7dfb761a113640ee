"""A folder in the navigation of mkdocs.yml stands for its pages, index.md or README.md first, or for nothing if it was not made; every page of
docs/ has to be in it."""

import logging
import pathlib

log = logging.getLogger("mkdocs.plugins.snug")


def pages_of(folder, docs):
    paths = sorted((docs / folder).glob("*.md"), key=lambda path: (path.name not in ("index.md", "README.md"), path.name))
    names = [str(path.relative_to(docs)) for path in paths]
    # Pages of commands, whose headings are usages, by their names.
    return [{path.stem: name} for path, name in zip(paths, names)] if folder == "command/" else names


def expanded(nav, docs):
    if isinstance(nav, list):
        made = [expanded(item, docs) for item in nav]
        return [item for item in made if not (isinstance(item, dict) and [] in item.values())]
    if isinstance(nav, dict):
        return {title: expanded(item, docs) for title, item in nav.items()}
    return pages_of(nav, docs) if nav.endswith("/") else nav


def on_config(config):
    config["nav"] = expanded(config["nav"], pathlib.Path(config["docs_dir"]))
    config["extra"]["live"] = (pathlib.Path(config["docs_dir"]) / "live.html").exists()
    return config


def on_nav(nav, config, files):
    listed = {page.file.src_uri for page in nav.pages}
    for file in files.documentation_pages():
        if file.src_uri not in listed and not file.src_uri.startswith("files/"):
            log.warning("%s is not in the navigation of mkdocs.yml", file.src_uri)
    return nav
