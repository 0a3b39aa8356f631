using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace UnityEditor.IMGUI.Controls
{
    public partial class AdvancedDropdownState
    {
    }

    public partial class AdvancedDropdownItem : IComparable
    {
        private readonly List<AdvancedDropdownItem> below = new List<AdvancedDropdownItem>();

        public AdvancedDropdownItem(string name) => this.name = name;

        public string name { get; set; }

        public int id { get; set; }

        public bool enabled { get; set; } = true;

        public IEnumerable<AdvancedDropdownItem> children => below;

        public void AddChild(AdvancedDropdownItem child) => below.Add(child);

        public virtual int CompareTo(object o) =>
            string.CompareOrdinal(name, ((AdvancedDropdownItem)o).name);
    }

    public abstract partial class AdvancedDropdown
    {
        protected AdvancedDropdown(AdvancedDropdownState state)
        {
        }

        /// <summary>The list that was shown last. Tests choose an entry from it.</summary>
        internal static AdvancedDropdown? Shown { get; private set; }

        internal IReadOnlyList<string> Names => BuildRoot().children.Select(item => item.name).ToList();

        protected Vector2 minimumSize { get; set; }

        public void Show(Rect rect) => Shown = this;

        internal void Pick(string name) => ItemSelected(BuildRoot().children.First(item => item.name == name));

        protected abstract AdvancedDropdownItem BuildRoot();

        protected virtual void ItemSelected(AdvancedDropdownItem item)
        {
        }
    }
}
