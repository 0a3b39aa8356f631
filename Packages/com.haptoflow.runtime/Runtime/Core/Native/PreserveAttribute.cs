#nullable enable
using System;

namespace HaptoFlow.Native
{
    /// <summary>Unity's linker keeps what carries an attribute of this name, whoever declares it: fields that no managed
    /// code reads are still part of a layout.</summary>
    [AttributeUsage(AttributeTargets.Class | AttributeTargets.Struct)]
    internal sealed class PreserveAttribute : Attribute
    {
    }
}
