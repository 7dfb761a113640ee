"""offline.py SITE: search/offline.js, the index of the search and its worker as a script. Files of the repository are not searched."""

import json
import pathlib
import sys

site = pathlib.Path(sys.argv[1])
index = json.loads((site / "search/search_index.json").read_text(encoding="utf-8"))
index["docs"] = [place for place in index["docs"] if not place["location"].startswith("files/")]
[worker] = site.glob("assets/javascripts/workers/search.*.min.js")
code = worker.read_text(encoding="utf-8").split("\n//# sourceMappingURL")[0]
(site / "search/offline.js").write_text(
    f"var __search = {{\n  index: Promise.resolve({json.dumps(index, ensure_ascii=False)}),\n"
    f"  worker: URL.createObjectURL(new Blob([{json.dumps(code)}], {{ type: 'text/javascript' }})),\n}};\n",
    encoding="utf-8")
(site / "search/search_index.json").unlink()
for unused in [*site.rglob("*.map"), *site.glob("sitemap.xml*"), *site.glob("assets/javascripts/lunr/**/*.js")]:
    unused.unlink()
