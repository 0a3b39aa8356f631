#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Editor
{
    /// <summary>Synonyms for materials, each with the labels that fit it, the best first. Words that often mean
    /// something else in the name of an object, such as "mesh" and "mat", are left out.</summary>
    internal static class LabelWords
    {
        private static readonly (string Labels, string Words)[] Groups =
        {
            ("wood", "oak pine walnut birch maple mahogany cedar beech teak spruce bamboo timber lumber plank wooden " +
                "parquet hardwood log"),
            ("plywood, wood", "ply mdf osb chipboard particleboard fibreboard fiberboard hardboard"),
            ("stone", "rock marble granite slate limestone sandstone cobble cobblestone pebble boulder basalt " +
                "travertine"),
            ("concrete, stone", "cement asphalt tarmac plaster stucco mortar"),
            ("brick, stone", "clinker masonry"),
            ("ceramic, glass", "porcelain tile earthenware terracotta pottery stoneware faience"),
            ("glass, ceramic", "crystal mirror window windshield"),
            ("metal", "steel iron aluminium aluminum brass copper bronze chrome titanium zinc nickel tin gold silver " +
                "metallic alloy"),
            ("metal mesh, metal", "grate grating grille chainlink wiremesh"),
            ("plastic", "acrylic pvc vinyl polymer plexiglass polycarbonate bakelite melamine laminate"),
            ("rubber, plastic", "silicone latex neoprene tyre tire eraser"),
            ("leather", "suede leatherette cowhide"),
            ("cotton", "cloth fabric linen textile canvas denim silk polyester wool curtain towel"),
            ("corduroy, cotton", "velvet velour"),
            ("jute, cotton", "burlap hessian sackcloth sisal hemp rope"),
            ("fur, carpet", "pelt plush fleece furry fluffy"),
            ("paper, cardboard", "newspaper parchment poster"),
            ("cardboard, paper", "carton paperboard corrugated"),
            ("sandpaper, stone", "emery abrasive"),
            ("carpet, cotton", "rug doormat tatami moquette"),
        };

        /// <summary>The labels for a word in lower case, in order of preference.</summary>
        public static IReadOnlyDictionary<string, string[]> All { get; } = ByWord();

        private static Dictionary<string, string[]> ByWord()
        {
            var all = new Dictionary<string, string[]>(StringComparer.Ordinal);
            foreach ((string labels, string words) in Groups)
            {
                string[] preferred = labels.Split(new[] { ", " }, StringSplitOptions.None);
                foreach (string word in words.Split(' '))
                {
                    all.Add(word, preferred);
                }
            }
            return all;
        }
    }
}
