#nullable enable
using System;
using System.Collections.Generic;
using UnityEditor.IMGUI.Controls;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>A searchable list of labels.</summary>
    internal sealed class LabelDropdown : AdvancedDropdown
    {
        private const float MinimumWidth = 200f;
        private const float MinimumHeight = 280f;

        private readonly IReadOnlyList<LabelOption> options;
        private readonly Action<string> choose;

        public LabelDropdown(IReadOnlyList<LabelOption> options, Action<string> choose)
            : base(new AdvancedDropdownState())
        {
            this.options = options;
            this.choose = choose;
            minimumSize = new Vector2(MinimumWidth, MinimumHeight);
        }

        protected override AdvancedDropdownItem BuildRoot()
        {
            var root = new AdvancedDropdownItem("Labels");
            foreach (LabelOption option in options)
            {
                root.AddChild(new Item(option));
            }
            return root;
        }

        protected override void ItemSelected(AdvancedDropdownItem item)
        {
            if (item is Item chosen)
            {
                choose(chosen.Label);
            }
        }

        private sealed class Item : AdvancedDropdownItem
        {
            public Item(LabelOption option)
                : base(option.Text) => Label = option.Label;

            public string Label { get; }
        }
    }
}
