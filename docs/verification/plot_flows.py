"""Laws of soils, mud and snow: paths without a grid, steady flows."""
from plot import axes, plot, read
from plot_cases import rows


@plot
def soil_paths():
    figure, ax = axes(3)
    clay, mud, snow = read("soil_paths_clay"), read("soil_paths_mud"), read("soil_paths_snow")
    for i, name in enumerate(dict.fromkeys(clay["path"])):
        at = rows(clay, path=name)
        ax[0].plot(at["p"], at["q"], f"C{i}-", label=name)
    most = 0.9 * max(clay["p"])
    ax[0].plot([0, most], [0, 1.05 * most], "k--", linewidth=0.8, label="critical state")
    ax[0].set_xlim(0, 500)
    ax[0].set_ylim(0, 300)
    ax[0].set_xlabel("p / kPa")
    ax[0].set_ylabel("q / kPa")
    ax[0].legend(fontsize=7)
    for i, n in enumerate(sorted(set(mud["n"]))):
        at = rows(mud, n=n)
        ax[1].loglog(at["rate"], at["exact"], "k-", linewidth=0.8)
        ax[1].loglog(at["rate"], at["stress"], f"C{i}o", markersize=4, label=f"n = {n:g}")
    ax[1].set_xlabel("rate of shear / (1/s)")
    ax[1].set_ylabel("shear stress / Pa")
    ax[1].legend()
    for parts, form in ((100, "-"), (1, "o")):
        at = rows(snow, parts=float(parts))
        for i, stress in enumerate(("xx", "yy", "xy")):
            ax[2].plot(at["leg"], [1e-3 * s for s in at[stress]], f"C{i}{form}", label=stress if parts > 1 else None)
    for leg, text in enumerate(("pressed", "sheared", "stretched")):
        ax[2].annotate(text, (leg + 0.5, 0.97), xycoords=("data", "axes fraction"), ha="center", va="top", fontsize=8)
    ax[2].set_xticks([0, 1, 2, 3])
    ax[2].set_ylim(-7, 5)
    ax[2].set_xlabel("leg of the path of snow")
    ax[2].set_ylabel("stress / kPa")
    ax[2].legend(loc="lower left")
    return figure


@plot
def yield_flows():
    figure, ax = axes(2)
    for panel, name, text in ((ax[0], "channel", "distance from the wall / m"), (ax[1], "slope", "height / m")):
        data = read(f"yield_flows_{name}")
        for i, flow in enumerate(dict.fromkeys(data["flow"])):
            at = rows(data, flow=flow)
            order = sorted(range(len(at["y"])), key=lambda k: at["y"][k])
            panel.plot([at["u_exact"][k] for k in order], [at["y"][k] for k in order], "k-", linewidth=1)
            panel.plot([at["u"][k] for k in order], [at["y"][k] for k in order], f"C{i}.", markersize=3, label=flow)
        panel.set_xlabel("speed / exact largest")
        panel.set_ylabel(text)
        panel.legend()
    return figure
