using System.Collections.Generic;

namespace UnityEngine.Events
{
    public delegate void UnityAction<T0>(T0 arg0);

    public abstract class UnityEventBase
    {
        internal abstract void Clear();
    }

    public class UnityEvent<T0> : UnityEventBase
    {
        private readonly List<UnityAction<T0>> calls = new List<UnityAction<T0>>();

        public void AddListener(UnityAction<T0> call) => calls.Add(call);

        internal override void Clear() => calls.Clear();

        public void Invoke(T0 arg0)
        {
            for (int index = 0; index < calls.Count; ++index)
            {
                calls[index](arg0);
            }
        }
    }
}
