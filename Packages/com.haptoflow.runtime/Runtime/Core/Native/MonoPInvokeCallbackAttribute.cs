#nullable enable
using System;

namespace HaptoFlow.Native
{
    /// <summary>Unity's ahead-of-time compiler makes a native entry for a static method that carries an attribute of
    /// this name, whoever declares it: this assembly knows no UnityEngine.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    internal sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        /// <param name="type">The delegate that the method is given out as.</param>
        public MonoPInvokeCallbackAttribute(Type type) => Type = type;

        public Type Type { get; }
    }
}
